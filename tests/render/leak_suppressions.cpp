// Suppresses a report of the leak sanitizer: a process that had an OSMesa context leaks 480 bytes in Mesa.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\n";
}
