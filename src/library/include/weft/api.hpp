// What the shared library shows to others.
#pragma once

#define WEFT_API __attribute__((visibility("default")))
