/// matio 1.5 loses some hundred bytes where it gives up on a damaged file, udunits 2.2 a word of
/// some wrong units; nothing of ours is hidden.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libmatio\nleak:libudunits2"; }
