// Mesa keeps 480 bytes for each process that ever had an OSMesa context; Weft cannot free them.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\n";
}
