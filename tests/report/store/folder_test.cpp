#include "report/store/folder.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/file.hpp"
#include "report/store/manifest.hpp"
#include "tests/support/command.hpp"

using namespace rigcal;
using namespace rigcal::report;
using Catch::Contains;
using Catch::EndsWith;

TEST_CASE("HeldFolder: leaves no trace", "[report]") {
  const test::CommandFolder folder;
  {
    const HeldFolder held(folder.work() / "a" / "b", {"fit"});
    CHECK(std::filesystem::is_empty(folder.work() / "a" / "b"));
  }
  CHECK(std::filesystem::is_empty(folder.work()));
  { const HeldFolder held(folder.work(), {"fit"}); }
  CHECK(std::filesystem::is_empty(folder.work()));
  {
    const HeldFolder held(folder.work() / "a" / "b", {"fit"});
    folder.write("a/result", "x");
  }
  CHECK(folder.read("a/result") == "x");
  CHECK_FALSE(folder.has("a/b"));
}

TEST_CASE("HeldFolder: what it made goes when a signal ends the process", "[report]") {
  const test::CommandFolder folder;
  const auto out = folder.work() / "a" / "b";
  {
    const HeldFolder held(out, {"fit"});
    HeldFolder::remove_if_empty();
    CHECK_FALSE(folder.has("a"));
  }
  const HeldFolder held(out, {"fit"});
  folder.write("a/b/result", "kept");
  HeldFolder::remove_if_empty();
  CHECK(folder.has("a/b/result"));
}

TEST_CASE("HeldFolder: for one at a time", "[report]") {
  const test::CommandFolder folder;
  const auto out = folder.work() / "out";
  {
    const HeldFolder held(out, {"fit"});
    CHECK_THROWS_AS(HeldFolder(out, {"fit"}), UsageError);
    CHECK_THROWS_WITH(HeldFolder(out, {"fit"}),
                      Contains("out: another run of rigcal writes into it"));
    const HeldFolder other(folder.work() / "other", {"fit"});
  }
  const HeldFolder again(out, {"fit"});
}

TEST_CASE("HeldFolder: names what is in the way", "[report]") {
  const test::CommandFolder folder;
  folder.write("file", "content");
  CHECK_THROWS_AS(HeldFolder(folder.work() / "file", {"fit"}), WriteError);
  CHECK_THROWS_WITH(HeldFolder(folder.work() / "file", {"fit"}),
                    EndsWith("file: is a file; expected a folder"));
  CHECK_THROWS_WITH(HeldFolder(folder.work() / "file" / "below", {"fit"}), Contains("file"));
  CHECK(folder.read("file") == "content");
}

namespace {

/// Writes the files of a run.
void write(const std::filesystem::path& out, const Holding& holding, const PlannedFiles& planned,
           const std::vector<ResultFile>& files) {
  HeldFolder held(out, holding);
  held.plan(planned);
  write_results(held, files, {});
}

}  // namespace

TEST_CASE("write_results: all or none", "[report]") {
  const test::CommandFolder folder;
  write(folder.work(), {"fit"}, {}, {{"first", "old"}});
  const auto before = folder.files();
  std::filesystem::create_directory(folder.work() / "second");
  HeldFolder held(folder.work(), {"fit"});
  CHECK_THROWS_AS(write_results(held, {{"first", "new"}, {"second", "new"}}, {}), WriteError);
  CHECK(folder.read("first") == "old");
  CHECK(folder.files() == before);
}

TEST_CASE("write_results: a first run that fails leaves no manifest", "[report]") {
  const test::CommandFolder folder;
  const std::vector<InputFile> no_inputs;
  HeldFolder held(folder.work(), {"fit"});
  ResultsInWriting writing(held, no_inputs);
  writing.add({"a", "x"});
  std::filesystem::create_directory(folder.work() / "a");  // in the way of the result
  CHECK_THROWS_AS(writing.move_into_place(), WriteError);
  CHECK_FALSE(folder.has(kManifestFile));
}

TEST_CASE("write_results: never over an input, and then nothing", "[report]") {
  const test::CommandFolder folder;
  folder.write("run.csv", "record");
  const std::vector<InputFile> inputs{{(folder.work() / "run.csv").string(), ""}};
  HeldFolder held(folder.work(), {"fit", true});
  CHECK_THROWS_WITH(write_results(held, {{"other.csv", "x"}, {"run.csv", "y"}}, inputs),
                    Contains("the result run.csv would replace the input"));
  CHECK(folder.files() == std::set<std::string>{"run.csv"});
  CHECK(folder.read("run.csv") == "record");
  write_results(held, {{"sub/other.csv", "x"}}, inputs);
  CHECK(folder.read("sub/other.csv") == "x");
}

TEST_CASE("HeldFolder: all files in the way are named before the work, some of many", "[report]") {
  const test::CommandFolder folder;
  write(folder.work(), {"fit"}, {}, {{"a", "x"}, {"b", "x"}});
  folder.write("b", "edited");
  PlannedFiles planned{{"a", "b"}, {}};
  for (int i = 10; i < 30; ++i) {
    const std::string name = "residuals/" + std::to_string(i);
    folder.write(name, "mine");
    planned.files.emplace_back(name);
  }
  HeldFolder held(folder.work(), {"fit"});
  CHECK_THROWS_WITH(held.plan(planned),
                    Contains("residuals/10") && Contains("residuals/17 and 12 more") &&
                        !Contains("residuals/18") && Contains("not written by rigcal") &&
                        Contains("b: changed since rigcal wrote it") && Contains("--force"));
  CHECK_NOTHROW(held.plan({{"a", "none"}, {"residuals"}}));
}

TEST_CASE("HeldFolder: a folder in the place of a file is named before the work", "[report]") {
  const test::CommandFolder folder;
  const auto out = folder.work() / "out";
  for (const bool force : {false, true}) {
    CAPTURE(force);
    {
      HeldFolder held(out, {"fit", force});
      std::filesystem::create_directories(out / "report.html");
      CHECK_THROWS_WITH(held.plan({{"report.html"}, {}}),
                        EndsWith("report.html: cannot be written: is a folder"));
      std::filesystem::remove(out / "report.html");
    }
    std::filesystem::create_directories(out / kManifestFile);
    CHECK_THROWS_AS(HeldFolder(out, {"fit", force}), WriteError);
    std::filesystem::remove(out / kManifestFile);
  }
}

TEST_CASE("HeldFolder: what is changed while a run lasts is kept", "[report]") {
  const test::CommandFolder folder;
  write(folder.work(), {"fit"}, {}, {{"a", "x"}});
  HeldFolder held(folder.work(), {"fit"});
  held.plan({{"a", "b"}, {}});
  folder.write("b", "mine");
  CHECK_THROWS_WITH(write_results(held, {{"a", "y"}, {"b", "y"}}, {}), Contains("b: not written"));
  CHECK(folder.read("a") == "x");
  CHECK(folder.read("b") == "mine");
  folder.write("a", "mine");
  CHECK_THROWS_WITH(write_results(held, {{"a", "y"}}, {}),
                    Contains("a: changed since rigcal wrote it"));
  CHECK(folder.read("a") == "mine");
}

TEST_CASE("write_results: what an earlier run left goes where it is as it was written",
          "[report]") {
  const test::CommandFolder folder;
  const PlannedFiles planned{{"fit.json", "fitted.toml"}, {"residuals"}};
  write(folder.work(), {"fit"}, planned,
        {{"residuals/a.csv", "x"},
         {"residuals/b.csv", "x"},
         {"residuals/c.csv", "x"},
         {"fitted.toml", "x"},
         {"fit.json", "x"}});
  write(folder.work(), {"average"}, {}, {{"averaged/a.csv", "x"}});
  folder.write("residuals/b.csv", "edited");
  folder.write("residuals/mine.csv", "x");
  write(folder.work(), {"fit"}, planned, {{"residuals/c.csv", "y"}, {"fit.json", "y"}});
  CHECK(folder.files() == std::set<std::string>{"averaged/a.csv", "fit.json", "residuals/b.csv",
                                                "residuals/c.csv", "residuals/mine.csv",
                                                kManifestFile});
  std::set<std::string> listed;
  for (const ManifestFile& file : manifest_files(folder.work())) listed.insert(file.path);
  CHECK(listed ==
        std::set<std::string>{"averaged/a.csv", "fit.json", "residuals/b.csv", "residuals/c.csv"});
}

TEST_CASE("HeldFolder: a manifest lists each file with the hash of what stands", "[report]") {
  const test::CommandFolder folder;
  write(folder.work(), {"fit"}, {}, {{"sub/a", "abc"}});
  write(folder.work(), {"fit"}, {}, {{"sub/a", "abcd"}, {"b", ""}});
  const auto files = manifest_files(folder.work());
  REQUIRE(files.size() == 2);
  for (const ManifestFile& file : files) {
    CHECK(file.sha256 == sha256_of_file(folder.work() / file.path));
    CHECK(file.verb == "fit");
  }
  // If a run was killed before the last rename, the manifest contains two hashes of a file. A file
  // with either of them counts as written by rigcal.
  auto both = files;
  both.push_back({"sub/a", sha256_of_text("abc"), "fit"});
  folder.write(kManifestFile, manifest_text(both));
  folder.write("sub/a", "abc");
  write(folder.work(), {"fit"}, {{"sub/a"}, {}}, {{"sub/a", "new"}});
  CHECK(folder.read("sub/a") == "new");
}

TEST_CASE("HeldFolder: a manifest that is none takes force", "[report]") {
  const test::CommandFolder folder;
  std::vector<std::string> texts{"", "{}",
                                 R"({"schema": "rigcal.manifest/2", "version": "9", "files": []})"};
  for (const char* path : {"../a", "/a", "a/../../b"})
    texts.push_back(manifest_text({{path, "", ""}}));
  for (const std::string& text : texts) {
    CAPTURE(text);
    folder.write(kManifestFile, text);
    CHECK_THROWS_AS(HeldFolder(folder.work(), {"fit"}), UsageError);
    CHECK_THROWS_WITH(HeldFolder(folder.work(), {"fit"}),
                      Contains(kManifestFile) && Contains("--force"));
    CHECK(folder.read(kManifestFile) == text);
    write(folder.work(), {"fit", true}, {}, {{"a", "x"}});
    CHECK(manifest_files(folder.work()).size() == 1);
  }
  std::filesystem::remove(folder.work() / kManifestFile);
  REQUIRE(::mkfifo((folder.work() / kManifestFile).c_str(), 0600) == 0);
  CHECK_THROWS_AS(HeldFolder(folder.work(), {"fit"}), UsageError);
  write(folder.work(), {"fit", true}, {}, {{"a", "x"}});
  CHECK(manifest_files(folder.work()).size() == 1);
}

TEST_CASE("HeldFolder: may be a link, but follows none inside", "[report]") {
  const test::CommandFolder folder;
  namespace fs = std::filesystem;
  fs::create_directories(folder.work() / "real");
  fs::create_directories(folder.work() / "elsewhere");
  fs::create_symlink("real", folder.work() / "out");
  fs::create_symlink("../elsewhere", folder.work() / "real" / "residuals");
  const Holding forced{"fit", true};
  for (const Holding& holding : {Holding{"fit"}, forced}) {
    HeldFolder held(folder.work() / "out", holding);
    CHECK_THROWS_WITH(held.plan({{}, {"residuals"}}), Contains("out/residuals: is a link"));
    CHECK_THROWS_WITH(write_results(held, {{"residuals/a.csv", "x"}}, {}),
                      Contains("out/residuals: is a link"));
  }
  CHECK(fs::is_empty(folder.work() / "elsewhere"));
  write(folder.work() / "out", {"fit"}, {}, {{"a", "x"}});
  CHECK(folder.read("real/a") == "x");
  // A link to a file does not count as written by rigcal. --force replaces the link, not its
  // target.
  folder.write("elsewhere/b", "mine");
  fs::create_symlink("../elsewhere/b", folder.work() / "real" / "b");
  CHECK_THROWS_WITH(write(folder.work() / "out", {"fit"}, {}, {{"b", "mine"}}),
                    Contains("b: not written by rigcal"));
  write(folder.work() / "out", forced, {}, {{"b", "x"}});
  CHECK(folder.read("elsewhere/b") == "mine");
  CHECK(folder.read("real/b") == "x");
}

TEST_CASE("HeldFolder: what a kill left goes, of a process that is no more", "[report]") {
  const test::CommandFolder folder;
  write(folder.work(), {"fit"}, {}, {{"residuals/a.csv", "x"}, {"fit.json", "x"}});
  const pid_t gone = ::fork();
  if (gone == 0) ::_exit(0);
  REQUIRE(::waitpid(gone, nullptr, 0) == gone);
  const std::string id = std::to_string(gone);
  const std::set<std::string> kept{
      ".mine.csv." + id + ".3.tmp", ".fit.json." + std::to_string(::getppid()) + ".3.tmp",
      ".fit.json." + id + ".3.tmpx", ".fit.json." + id + "x.3.tmp", "fit.json." + id + ".3.tmp"};
  for (const std::string& name : kept) folder.write(name, "kept");
  for (const std::string& name :
       {".fit.json." + id + ".3.tmp", "residuals/.a.csv." + id + ".14.tmp",
        "residuals/.new.csv." + id + ".0.tmp", "..rigcal-probe." + id + ".0.tmp",
        ".fit.json." + std::to_string(::getpid()) + ".9999.tmp"})
    folder.write(name, "left");
  HeldFolder held(folder.work(), {"fit"});
  held.plan({{"residuals/new.csv"}, {}});
  std::set<std::string> expected = kept;
  expected.insert({"residuals/a.csv", "fit.json", kManifestFile});
  CHECK(folder.files() == expected);
}
