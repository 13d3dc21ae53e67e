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

/// libFuzzer calls this with each input; a return value of 0 accepts the input. An exception that
/// escapes or an abort is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace rigcal::fuzz {

inline std::string_view text_of_bytes(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A temporary folder for this process, in memory if the system supports that.
inline const std::filesystem::path& scratch_folder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path memory = "/dev/shm";
    const auto above =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    const auto path = above / ("rigcal-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
    std::atexit([] {
      std::error_code ignored;  // leftovers do no harm
      std::filesystem::remove_all(scratch_folder(), ignored);
    });
    return path;
  }();
  return folder;
}

/// Creates a file with the given content, replacing any earlier file with that name.
inline std::filesystem::path scratch_file(const std::string& name, std::string_view content) {
  const std::filesystem::path path = scratch_folder() / name;
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

/// Aborts if an input violates a property that every input must have.
inline void require(bool holds, const char* property) {
  if (holds) return;
  std::cerr << "violated: " << property << '\n';
  std::abort();
}

}  // namespace rigcal::fuzz
