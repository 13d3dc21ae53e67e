#include "common/error.hpp"
#include "common/file.hpp"
#include "report/json/read_json.hpp"
#include "report/store/checkpoint.hpp"
#include "report/store/json.hpp"
#include "tests/fuzz/fuzz.hpp"
#ifdef RIGCAL_LIBFUZZER
#include "tests/fuzz/json_mutator.hpp"
#endif

using namespace rigcal;

namespace {

/// Identity of the fit to which a checkpoint belongs. It includes version and revision, which are
/// not known to a corpus, so inputs have a placeholder.
const std::string& fit_identity() {
  static const std::string text =
      report::parse_json(report::checkpoint_text({}, {}), "identity").at("fit").dump();
  return text;
}

constexpr std::string_view kIdentitySign = "\"@FIT@\"";

/// Gives a checkpoint the hash of its own content, so that the reader goes on to the content.
std::string with_own_hash(const std::string& text) {
  try {
    report::Json json = report::parse_json(text, "input");
    if (!json.is_object()) return text;
    json.erase("sha256");
    json["sha256"] = sha256_of_text(report::json_text(json));
    return report::json_text(json);
  } catch (const InputError&) {
    return text;
  }
}

}  // namespace

/// A checkpoint is either rejected or unchanged after it has been read, written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(fuzz::text_of_bytes(data, size));
  if (const auto at = text.find(kIdentitySign); at != std::string::npos)
    text.replace(at, kIdentitySign.size(), fit_identity());
  calib::Checkpoint checkpoint;
  try {
    checkpoint =
        report::read_checkpoint(fuzz::scratch_file("checkpoint.json", with_own_hash(text)), {});
  } catch (const InputError&) {
    return 0;
  }
  const std::string written = report::checkpoint_text(checkpoint, {});
  const auto again = report::read_checkpoint(fuzz::scratch_file("again.json", written), {});
  fuzz::require(report::checkpoint_text(again, {}) == written, "a checkpoint reads back");
  return 0;
}

#ifdef RIGCAL_LIBFUZZER
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most_bytes, unsigned seed) {
  return fuzz::mutate_json_text(data, size, most_bytes, seed);
}
#endif
