#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "datasets/read/byte_stream.hpp"
#include "datasets/read/mat/mat_array.hpp"

namespace rigcal::datasets {

/// Reads MAT files of level 5 (also "v6", "v7"), strictly, according to "MAT-File Format" by The
/// MathWorks. Every size in the file is checked against its container before it is used. Every
/// variable is read to its end once, which detects truncation and, in compressed variables, damage.
/// Memory use is bounded by the numbers requested.
class Level5Source : public MatSource {
 public:
  /// @throws InputError  if the file is not a regular file of this kind, is damaged, has more than
  ///                     200 000 arrays, or has compressed variables that inflate to more than
  ///                     `most_inflated_bytes`
  explicit Level5Source(const std::filesystem::path& path,
                        std::uint64_t most_inflated_bytes = std::uint64_t{4} << 30);

  const std::string& name() const override { return name_; }
  const std::vector<MatArray>& variables() const override { return variables_; }
  std::vector<double> numbers(const MatArray& array, const MatSelection& selection,
                              const std::string& column) override;

 private:
  /// Position of a variable in the file.
  struct Range {
    std::uint64_t begin = 0;
    std::uint64_t bytes = 0;
    bool compressed = false;
  };

  std::unique_ptr<ByteStream> open(const Range& range);
  void read_variable(const Range& range);

  std::string name_;
  std::ifstream file_;
  bool swapped_ = false;
  std::vector<Range> ranges_;
  std::vector<MatArray> variables_;
  std::size_t arrays_ = 0;
  std::uint64_t inflated_bytes_ = 0;
  std::uint64_t most_inflated_bytes_;
  /// Stream of the variable that was last read, kept because successive columns are often in the
  /// same variable.
  std::unique_ptr<ByteStream> stream_;
  std::size_t stream_of_ = 0;
};

}  // namespace rigcal::datasets
