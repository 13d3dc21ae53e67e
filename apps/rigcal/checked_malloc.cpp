// Eigen allocates by malloc(), and after std::bad_alloc its matrices are inconsistent: they free
// memory twice that they could not enlarge. So code that is linked into the program (--wrap in
// apps/CMakeLists.txt) runs out of memory like operator new: the new handler ends it.

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

/// While a file is being written the handler returns or throws; then the caller gets the error.
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
