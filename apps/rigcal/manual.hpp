#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace rigcal::app {

// The manual is generated from the same definitions as the output of --help, so that the two cannot
// differ.

/// Returns the manual page rigcal(1) in roff.
std::string man_page(const CLI::App& app);

inline constexpr std::array<std::string_view, 3> kShells{"bash", "zsh", "fish"};

/// Returns a script that lets a shell complete verbs, options and paths.
///
/// @param shell  one of kShells
/// @throws UsageError  if the shell is unknown
std::string completion(const CLI::App& app, std::string_view shell);

/// Returns the verbs in the order of --help.
std::vector<const CLI::App*> verbs_of(const CLI::App& app);

}  // namespace rigcal::app
