#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

/// What libFuzzer calls with each input; 0: it counts. Whatever escapes from it, or aborts, is a
/// find.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace rigcal::fuzz {

inline std::string_view text_of_bytes(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process, in memory where the system has such a place.
inline const std::filesystem::path& scratch_folder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path memory = "/dev/shm";
    const auto above =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    const auto path = above / ("rigcal-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
    std::atexit([] {
      std::error_code ignored;  // what stays behind harms nothing
      std::filesystem::remove_all(scratch_folder(), ignored);
    });
    return path;
  }();
  return folder;
}

/// A file of this content; the one of that name before it is gone.
inline std::filesystem::path scratch_file(const std::string& name, std::string_view content) {
  const std::filesystem::path path = scratch_folder() / name;
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

/// A property that every input must have.
inline void require(bool holds, const char* property) {
  if (holds) return;
  std::cerr << "violated: " << property << '\n';
  std::abort();
}

}  // namespace rigcal::fuzz
