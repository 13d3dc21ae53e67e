#include <algorithm>
#include <cstdio>
#include <exception>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

/// Passes every file in the given folders to the fuzz target, so that earlier findings cannot recur
/// unnoticed.
int main(int argc, char** argv) {
  int count = 0;
  for (int i = 1; i < argc; ++i) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(argv[i]))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
      std::printf("%s\n", file.c_str());
      std::fflush(stdout);  // shows which file was the last if the process ends
      std::ifstream stream(file, std::ios::binary);
      const std::string content{std::istreambuf_iterator<char>(stream), {}};
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
      ++count;
    }
  }
  return count > 0 ? 0 : 1;
}
