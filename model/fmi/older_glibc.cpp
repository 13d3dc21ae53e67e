// Only the library of the FMU includes this file. It replaces functions from glibc versions after
// 2.34 that the static libstdc++ and libgcc call, so that the library loads with an older glibc.
#include <dlfcn.h>
#include <link.h>

#include <bit>
#include <cstddef>
#include <cstdint>

// glibc 2.35 added _dl_find_object(), which finds the loaded object that contains an address. The
// unwinder in libgcc calls it; older versions use dl_iterate_phdr().
#ifdef DLFO_EH_SEGMENT_TYPE

namespace {

struct Search {
  std::uintptr_t address;
  dl_find_object* found;
};

/// Returns 1, which ends the search, if the object contains the address.
int look_into(dl_phdr_info* object, std::size_t /*size*/, void* data) {
  Search& search = *static_cast<Search*>(data);
  bool holds = false;
  std::uintptr_t begin = UINTPTR_MAX;
  std::uintptr_t end = 0;
  std::uintptr_t frames = 0;
  for (std::size_t i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    const std::uintptr_t start = object->dlpi_addr + segment.p_vaddr;
    if (segment.p_type == DLFO_EH_SEGMENT_TYPE) frames = start;
    if (segment.p_type != PT_LOAD) continue;
    if (start < begin) begin = start;
    if (start + segment.p_memsz > end) end = start + segment.p_memsz;
    if (search.address >= start && search.address - start < segment.p_memsz) holds = true;
  }
  if (!holds || frames == 0) return 0;
  *search.found = {};
  search.found->dlfo_map_start = std::bit_cast<void*>(begin);
  search.found->dlfo_map_end = std::bit_cast<void*>(end);
  search.found->dlfo_eh_frame = std::bit_cast<void*>(frames);
  return 1;
}

}  // namespace

extern "C" __attribute__((visibility("hidden"))) int _dl_find_object(
    void* address, dl_find_object* found) noexcept {
  Search search{reinterpret_cast<std::uintptr_t>(address), found};
  return dl_iterate_phdr(look_into, &search) == 1 ? 0 : -1;
}

#endif

// Since glibc 2.38, strtoul() accepts "0b1", too, and code compiled with it calls a new symbol.
// libstdc++ parses an environment variable with it.
#ifdef __GLIBC_PREREQ
#if __GLIBC_PREREQ(2, 38)

extern "C" unsigned long strtoul_of_any_glibc(const char* text, char** end, int base) noexcept
    __asm__("strtoul");

extern "C" __attribute__((visibility("hidden"))) unsigned long __isoc23_strtoul(const char* text,
                                                                                char** end,
                                                                                int base) noexcept {
  return strtoul_of_any_glibc(text, end, base);
}

#endif
#endif
