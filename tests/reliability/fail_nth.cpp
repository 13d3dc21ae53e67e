// Preloaded into rigcal by tests/reliability/faults.py. Makes one call of a given kind fail, as if
// memory or disk had run out.
//
// RIGCAL_FAIL=KIND:N  the N-th call of this kind fails; 0: none fails
//   memory            operator new
//   malloc            malloc() and related functions, called by the program itself (Eigen) or
//                     by a C library
//   locks             every flock(), without a number: as on NFS without its lock daemon
//   files             opening for writing, writing, syncing, closing, renaming, linking, making a
//                     folder
// RIGCAL_COUNT=FILE   file to which the numbers of calls are written at the end, in this order
//
// Counting begins with main(), whose first call is mallopt(), because earlier failures are not the
// program's. UDUNITS-2 is exempt, because it does not check its allocations, and crashes or loses
// units. OpenSSL is exempt, because version 3.5 deadlocks if memory runs out during its
// initialisation. glibc, libstdc++ and the loader are exempt, because they recover or end the
// program.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <new>

namespace {

std::atomic<bool> counting{false};
std::atomic<long> allocations{0};
std::atomic<long> mallocs{0};
std::atomic<long> file_calls{0};
long failing_allocation = 0;
long failing_malloc = 0;
long failing_file_call = 0;

// glibc's own functions. They need no lookup, which would allocate memory.
extern "C" void* __libc_malloc(std::size_t);
extern "C" void* __libc_calloc(std::size_t, std::size_t);
extern "C" void* __libc_realloc(void*, std::size_t);
extern "C" void* __libc_memalign(std::size_t, std::size_t);

/// Whether an address is in code whose allocations count.
bool counts(const void* address) {
  Dl_info info{};
  if (::dladdr(address, &info) == 0 || info.dli_fname == nullptr) return false;
  static const void* const own = [] {
    Dl_info mine{};
    ::dladdr(reinterpret_cast<const void*>(&counts), &mine);
    return static_cast<const void*>(mine.dli_fbase);
  }();
  if (info.dli_fbase == own) return false;
  const char* const slash = std::strrchr(info.dli_fname, '/');
  const char* const name = slash == nullptr ? info.dli_fname : slash + 1;
  for (const char* left_out : {"libc.so", "libm.so", "ld-linux", "libstdc++", "libgcc_s",
                               "libudunits2", "libexpat", "libcrypto"}) {
    if (std::strncmp(name, left_out, std::strlen(left_out)) == 0) return false;
  }
  return true;
}

/// Whether a malloc() called from this address fails.
bool malloc_fails(const void* caller) {
  return counting && counts(caller) && ++mallocs == failing_malloc;
}

void* not_enough_memory() {
  errno = ENOMEM;
  return nullptr;
}

long number_after(const char* text, const char* kind) {
  const std::size_t length = std::strlen(kind);
  return std::strncmp(text, kind, length) == 0 ? std::atol(text + length) : 0;
}

void* allocated(std::size_t alignment, std::size_t size) {
  const bool fails = counting && ++allocations == failing_allocation;
  void* const memory =
      fails ? nullptr : __libc_memalign(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory != nullptr) return memory;
  if (const std::new_handler handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}

bool file_call_fails(int reason) {
  if (!counting || ++file_calls != failing_file_call) return false;
  errno = reason;
  return true;
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void write_counts() {
  counting = false;
  const char* const path = std::getenv("RIGCAL_COUNT");
  if (path == nullptr) return;
  std::FILE* const file = std::fopen(path, "w");
  if (file == nullptr) return;
  std::fprintf(file, "%ld %ld %ld\n", allocations.load(), mallocs.load(), file_calls.load());
  std::fclose(file);
}

}  // namespace

extern "C" {

int mallopt(int parameter, int value) {
  static const auto real = next<int(int, int)>("mallopt");
  const int result = real(parameter, value);
  if (counting) return result;
  if (const char* const which = std::getenv("RIGCAL_FAIL")) {
    failing_allocation = number_after(which, "memory:");
    failing_malloc = number_after(which, "malloc:");
    failing_file_call = number_after(which, "files:");
    std::atexit(write_counts);
    counting = true;
  }
  return result;
}

void* malloc(std::size_t size) {
  return malloc_fails(__builtin_return_address(0)) ? not_enough_memory() : __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  return malloc_fails(__builtin_return_address(0)) ? not_enough_memory()
                                                   : __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  return malloc_fails(__builtin_return_address(0)) ? not_enough_memory()
                                                   : __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return malloc_fails(__builtin_return_address(0)) ? not_enough_memory()
                                                   : __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  if (malloc_fails(__builtin_return_address(0))) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}

ssize_t write(int descriptor, const void* bytes, std::size_t count) {
  static const auto real = next<ssize_t(int, const void*, std::size_t)>("write");
  return file_call_fails(ENOSPC) ? -1 : real(descriptor, bytes, count);
}

int fsync(int descriptor) {
  static const auto real = next<int(int)>("fsync");
  return file_call_fails(EIO) ? -1 : real(descriptor);
}

int mkdir(const char* path, unsigned mode) {
  static const auto real = next<int(const char*, unsigned)>("mkdir");
  return file_call_fails(ENOSPC) ? -1 : real(path, mode);
}

int rename(const char* from, const char* to) {
  static const auto real = next<int(const char*, const char*)>("rename");
  return file_call_fails(EIO) ? -1 : real(from, to);
}

// The function has another name here, because <fcntl.h> has a struct called flock.
int lock_file(int descriptor, int operation) asm("flock");
int lock_file(int descriptor, int operation) {
  static const auto real = next<int(int, int)>("flock");
  const char* const which = std::getenv("RIGCAL_FAIL");
  if (which == nullptr || std::strcmp(which, "locks") != 0) return real(descriptor, operation);
  errno = ENOLCK;
  return -1;
}

int link(const char* from, const char* to) {
  static const auto real = next<int(const char*, const char*)>("link");
  return file_call_fails(ENOSPC) ? -1 : real(from, to);
}

// Only files opened for writing count. `mode` is passed only if a file may be created.
int open(const char* path, int flags, ...) {
  static const auto real = next<int(const char*, int, ...)>("open");
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    std::va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, mode_t);
    va_end(arguments);
  }
  const bool writes = (flags & O_ACCMODE) != O_RDONLY;
  return writes && file_call_fails(ENOSPC) ? -1 : real(path, flags, mode);
}

// The file is closed even if the call fails.
int close(int descriptor) {
  static const auto real = next<int(int)>("close");
  const int result = real(descriptor);
  return file_call_fails(EIO) ? -1 : result;
}

}  // extern "C"

void* operator new(std::size_t size) { return allocated(alignof(std::max_align_t), size); }
void* operator new[](std::size_t size) { return allocated(alignof(std::max_align_t), size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocated(static_cast<std::size_t>(alignment), size);
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocated(static_cast<std::size_t>(alignment), size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
