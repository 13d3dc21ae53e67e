// Eigen allocates with malloc(). If that fails while a matrix is being enlarged, the matrix is left
// inconsistent and frees its memory twice. The functions below replace malloc() and realloc()
// (--wrap in apps/CMakeLists.txt). Like operator new, they call the new handler when memory runs
// out, and the handler ends the program.

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

/// Calls the new handler if an allocation failed. While a file is being written the handler returns
/// or throws, and the caller gets the error.
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
