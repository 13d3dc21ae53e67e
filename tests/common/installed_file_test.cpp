#include "common/installed_file.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;

TEST_CASE("files of share/ are found beside the folder of the program") {
  const fs::path folder =
      fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "installed_test";
  fs::create_directories(folder);
  std::ofstream(folder / "file") << "x";
  CHECK(rigcal::installed_file("installed_test/file") == folder / "file");
  CHECK_FALSE(rigcal::installed_file("installed_test/other"));
  CHECK_FALSE(rigcal::installed_file("installed_test"));  // a folder
  fs::remove_all(folder);
  CHECK_FALSE(rigcal::installed_file("installed_test/file"));
}
