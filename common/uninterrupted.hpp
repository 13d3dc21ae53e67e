#pragma once

namespace rigcal {

/// While one lives, in whatever thread, the end that a signal brings waits: for work that must not
/// be left half done, such as files that are written beside their places.
class Uninterrupted {
 public:
  Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
  /// Raises the signal that had to wait, if this was the last one.
  ~Uninterrupted();

  /// For a handler: whether `signal` has to wait, as it then will. Safe within one.
  static bool postpones(int signal);
};

}  // namespace rigcal
