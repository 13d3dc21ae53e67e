#include "common/file.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "common/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Catch::Contains;
using rigcal::FilesInWriting;
using rigcal::InputError;
using rigcal::read_file;
using rigcal::require_regular_file;
using rigcal::sha256_of_file;
using rigcal::write_file_atomically;
using rigcal::WriteError;
using rigcal::test::TemporaryFolder;
using rigcal::test::text_of;

namespace {

std::ptrdiff_t entries(const TemporaryFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
}

}  // namespace

TEST_CASE("write_file_atomically: writes, replaces, leaves nothing beside", "[common]") {
  const TemporaryFolder folder;
  const std::string binary("a\0b\n\xFF", 5);
  write_file_atomically(folder / "out.json", "first, and longer");
  write_file_atomically(folder / "out.json", binary);
  CHECK(text_of(folder / "out.json") == binary);
  CHECK(entries(folder) == 1);
  write_file_atomically(folder / "empty", "");
  CHECK(fs::file_size(folder / "empty") == 0);
}

TEST_CASE("write_file_atomically: makes missing folders", "[common]") {
  const TemporaryFolder folder;
  write_file_atomically(folder / "a/b/c.csv", "x");
  CHECK(text_of(folder / "a/b/c.csv") == "x");
}

TEST_CASE("write_file_atomically: others may read the file as the umask says", "[common]") {
  const TemporaryFolder folder;
  write_file_atomically(folder / "made", "x");
  std::ofstream(folder / "reference") << "x";
  CHECK(fs::status(folder / "made").permissions() ==
        fs::status(folder / "reference").permissions());
}

TEST_CASE("write_file_atomically: a folder in the way", "[common]") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "taken");
  CHECK_THROWS_WITH(write_file_atomically(folder / "taken", "x"),
                    Contains("taken") && Contains("cannot be written: "));
  CHECK(entries(folder) == 1);
  CHECK_THROWS_AS(write_file_atomically(folder / "taken/", "x"), WriteError);
}

TEST_CASE("write_file_atomically: a file where a folder should be", "[common]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  CHECK_THROWS_WITH(write_file_atomically(folder / "file/out.csv", "x"),
                    Contains("out.csv: cannot be written: "));
  CHECK_THROWS_AS(write_file_atomically("/proc/no_such_folder/out.csv", "x"), WriteError);
}

TEST_CASE("write_file_atomically: a full disk leaves the old file as it was", "[common]") {
  const TemporaryFolder folder;
  write_file_atomically(folder / "out.csv", "old");
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // makes write() fail instead
  rlimit small = before;
  small.rlim_cur = 4096;
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  std::string message = "no error";
  try {
    write_file_atomically(folder / "out.csv", std::string(100'000, 'x'));
  } catch (const WriteError& error) {
    message = error.what();
  }
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &before) == 0);
  std::signal(SIGXFSZ, handler);
  CHECK_THAT(message, Contains("out.csv: cannot be written: "));
  CHECK(text_of(folder / "out.csv") == "old");
  CHECK(entries(folder) == 1);
}

TEST_CASE("write_file_atomically: what a killed process of this number left is no obstacle",
          "[common]") {
  const TemporaryFolder folder;
  for (int i = 0; i < 100; ++i)
    std::ofstream(folder / fmt::format(".out.csv.{}.{}.tmp", ::getpid(), i)) << "left";
  write_file_atomically(folder / "out.csv", "x");
  CHECK(text_of(folder / "out.csv") == "x");
  CHECK(entries(folder) == 101);
}

TEST_CASE("FilesInWriting: nothing in its place before all are, nothing left of what is not",
          "[common]") {
  const TemporaryFolder folder;
  write_file_atomically(folder / "first", "old");
  {
    FilesInWriting writing;
    writing.add(folder / "first", "new");
    writing.add(folder / "second", "new");
    CHECK(text_of(folder / "first") == "old");
    CHECK_FALSE(fs::exists(folder / "second"));
    CHECK(entries(folder) == 3);
  }
  CHECK(entries(folder) == 1);
  FilesInWriting writing;
  writing.add(folder / "first", "new");
  writing.rename_into_place();
  CHECK(text_of(folder / "first") == "new");
  CHECK(entries(folder) == 1);
}

TEST_CASE("FilesInWriting: the end of a process takes back what every one of them has written",
          "[common]") {
  const TemporaryFolder folder;
  FilesInWriting first;
  FilesInWriting second;
  {
    FilesInWriting gone;
    gone.add(folder / "gone", "x");
  }
  first.add(folder / "a", "x");
  second.add(folder / "b", "x");
  second.rename_into_place();
  second.add(folder / "c", "x");
  CHECK(entries(folder) == 3);
  FilesInWriting::remove_all();
  CHECK(entries(folder) == 1);
  CHECK(text_of(folder / "b") == "x");
}

TEST_CASE("FilesInWriting: a rename that fails takes back those before it", "[common]") {
  const TemporaryFolder folder;
  write_file_atomically(folder / "first", "old");
  write_file_atomically(folder / "target", "old");
  fs::create_symlink("target", folder / "link");
  {
    FilesInWriting writing;
    writing.add(folder / "first", "new");
    writing.add(folder / "new", "new");
    writing.add(folder / "link", "new");
    writing.add(folder / "first", "newer");
    writing.add(folder / "last", "new");
    fs::create_directory(folder / "last");
    CHECK_THROWS_WITH(writing.rename_into_place(), Contains("last: cannot be written"));
  }
  CHECK(text_of(folder / "first") == "old");
  CHECK(text_of(folder / "target") == "old");
  CHECK(fs::read_symlink(folder / "link") == "target");
  CHECK_FALSE(fs::exists(folder / "new"));
  CHECK(entries(folder) == 4);
}

TEST_CASE("read_file: all bytes of a regular file, up to a limit", "[common]") {
  const TemporaryFolder folder;
  const std::string binary("a\0b\n\xFF", 5);
  const fs::path file = folder.write("file", binary);
  CHECK(read_file(file, 5, "a test") == binary);
  CHECK(read_file(folder.write("empty", ""), 0, "a test").empty());
  CHECK_THROWS_WITH(read_file(file, 4, "a test"),
                    Contains("file: has 5 bytes; expected a test of at most"));
  // The system reports a size of zero for this file, so it must be read to its end.
  CHECK(read_file("/proc/self/status", 1 << 20, "a test").find("Name:") == 0);
  CHECK_THROWS_AS(read_file("/proc/self/status", 10, "a test"), InputError);
}

TEST_CASE("read_file: never waits for a pipe, never reads a device", "[common]") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  for (const fs::path& path : {folder / "pipe", fs::path("/dev/zero")}) {
    CHECK_THROWS_WITH(read_file(path, 100, "a test"),
                      Contains("is not a regular file; expected a test"));
    CHECK_THROWS_AS(require_regular_file(path, "a test"), InputError);
    CHECK_THROWS_AS(sha256_of_file(path), InputError);
  }
  CHECK_THROWS_WITH(read_file(folder.path(), 100, "a test"), Contains("is a folder"));
  CHECK_THROWS_WITH(read_file(folder / "none", 100, "a test"), Contains("No such file"));
}

TEST_CASE("sha256_of_file: published test vectors", "[common]") {
  // FIPS 180-2, appendix B: "abc", the message with 56 bytes, and "a" repeated a million times.
  const TemporaryFolder folder;
  const auto sum = [&folder](const std::string& text) {
    write_file_atomically(folder / "text", text);
    return sha256_of_file(folder / "text");
  };
  CHECK(sum("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sum("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sum("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sum(std::string(1'000'000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("sha256_of_file: what cannot be read is an error", "[common]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(sha256_of_file(folder / "missing"),
                    Contains("missing: cannot be opened: No such file"));
  CHECK_THROWS_AS(sha256_of_file(folder / ""), InputError);
}

TEST_CASE("sha256_of_unchanged: the hash is of the bytes that were read", "[common]") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("data.csv", "1\n");
  rigcal::FileState before = rigcal::state_of_file(file);
  CHECK(before.bytes == 2);
  CHECK(rigcal::sha256_of_unchanged(before) == sha256_of_file(file));
  const auto refused = [&] {
    CHECK_THROWS_WITH(rigcal::sha256_of_unchanged(before),
                      Contains("data.csv: was changed while it was read"));
    before = rigcal::state_of_file(file);
  };
  std::ofstream(file, std::ios::app) << "2\n";  // the file grows
  refused();
  fs::rename(folder.write("other.csv", "1\n2\n"), file);  // another file with the same content
  refused();
  fs::resize_file(file, 2);
  refused();
  // A change that leaves the size shows in the time, once the clock of the file system has moved.
  for (int tries = 0; tries < 300 && rigcal::state_of_file(file) == before; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::fstream(file, std::ios::in | std::ios::out) << "3\n";
  }
  refused();
  fs::remove(file);
  CHECK_THROWS_AS(rigcal::sha256_of_unchanged(before), InputError);
}
