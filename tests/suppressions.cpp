/// matio 1.5 leaks some hundred bytes when it rejects a damaged file, and udunits 2.2 leaks a word
/// for some invalid units. Leaks in our own code are not suppressed.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libmatio\nleak:libudunits2"; }
