#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace rigcal {

/// Exit codes of the command (docs/command-line.md).
enum class ExitCode : int {
  done = 0,
  verdict_fail = 1,
  bad_input = 2,
  no_result = 3,
  stopped = 4,
  internal = 5,
};

/// Base of every error that reaches the user; carries the exit code of the process.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Thrown if the command line is invalid.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitCode::bad_input, message) {}
};

/// Place of an error in a file. Line and column count from 1; 0 means unknown.
struct Location {
  std::string file;
  long line = 0;
  long column = 0;

  /// Returns "file:line:column", as far as known.
  std::string text() const {
    std::string result = file;
    if (line > 0) result.append(":").append(std::to_string(line));
    if (line > 0 && column > 0) result.append(":").append(std::to_string(column));
    return result;
  }
};

/// Thrown if a campaign or record file is invalid. what() reads "file:line:column: message".
class InputError : public Error {
 public:
  InputError(Location where, const std::string& message)
      : Error(ExitCode::bad_input, where.text() + ": " + message), where_(std::move(where)) {}
  const Location& where() const { return where_; }

 private:
  Location where_;
};

/// Thrown if there is no usable result: every start failed, or nothing could be simulated.
class NoResultError : public Error {
 public:
  explicit NoResultError(const std::string& message) : Error(ExitCode::no_result, message) {}
};

/// Thrown if a result file could not be written.
class WriteError : public Error {
 public:
  explicit WriteError(const std::string& message) : Error(ExitCode::internal, message) {}
};

}  // namespace rigcal
