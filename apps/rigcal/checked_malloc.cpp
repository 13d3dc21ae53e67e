// Eigen allocates by malloc(), and its matrices are not whole again after std::bad_alloc: they free
// twice what they could not enlarge. So what is linked into the program (--wrap in
// apps/CMakeLists.txt) runs out of memory as operator new does: by the new handler, which ends it.

#include <cstddef>
#include <new>

// NOLINTBEGIN(bugprone-reserved-identifier): the names that the linker expects
extern "C" {

void* __real_malloc(std::size_t size);
void* __real_realloc(void* memory, std::size_t size);

void* __wrap_malloc(std::size_t size);
void* __wrap_realloc(void* memory, std::size_t size);

}  // extern "C"

namespace {

/// The handler returns or throws where a file is being written: then the caller is told.
void* checked(void* memory, std::size_t size) {
  if (memory != nullptr || size == 0) return memory;
  try {
    if (const std::new_handler handler = std::get_new_handler()) handler();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  return nullptr;
}

}  // namespace

void* __wrap_malloc(std::size_t size) { return checked(__real_malloc(size), size); }

void* __wrap_realloc(void* memory, std::size_t size) {
  return checked(__real_realloc(memory, size), size);
}
// NOLINTEND(bugprone-reserved-identifier)
