#pragma once

namespace rigcal {

/// While one lives, in whatever thread, the end that a signal brings waits: for work that must not
/// be left half done, such as files that are written beside their places.
class Uninterrupted {
 public:
  /// Waits for ever where the end has come.
  Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
  /// Raises the signal that had to wait, if this was the last one.
  ~Uninterrupted();

  /// Whether one lives.
  static bool any();

  /// For a signal handler, and safe within one: whether `signal` has to wait, as it then will. If
  /// not, no other thread begins anything, and the handler must end the process.
  static bool postpones(int signal);
};

}  // namespace rigcal
