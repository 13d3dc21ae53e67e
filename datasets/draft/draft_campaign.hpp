#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/draft/draft_comment.hpp"

namespace rigcal::datasets {

struct Draft {
  std::string text;                   ///< text of a campaign file, with comments
  std::vector<std::string> left_out;  ///< files that the draft does not use, and why
};

/// Drafts a campaign file from recordings. It takes columns and units from their names, repeats
/// from files or columns that differ in a number at the end, and waveform, frequency and amplitude
/// from the signals. Values that the files do not give are left blank. With the blanks filled in,
/// the draft is a campaign that can be loaded.
///
/// The plant has two chambers if either chamber pressure is among the columns.
///
/// @param files  recordings in any format; those whose names differ only in their last number are
///               repeats
/// @param folder  record paths are written relative to this folder
/// @return  the draft. A file without a time or a channel is left out, as is the first file of a
///          group if it cannot be read; comments in the text name these files, too
/// @throws InputError  if no file remains; the message describes the problem with the first file
Draft draft_campaign(const std::vector<std::filesystem::path>& files,
                     const std::filesystem::path& folder);

}  // namespace rigcal::datasets
