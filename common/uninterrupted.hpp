#pragma once

namespace rigcal {

/// While an object of this class exists, in any thread, a signal does not end the process. Meant
/// for work that must not be left half done, such as moving a set of files into place.
class Uninterrupted {
 public:
  /// Never returns if the process is already ending.
  Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
  /// Raises the signal that was postponed, if this was the last object.
  ~Uninterrupted();

  /// Whether any object exists.
  static bool any();

  /// Returns whether `signal` must wait, and if so, postpones it. Otherwise no other thread can
  /// begin such work any more, and the handler must end the process. Safe to call within a signal
  /// handler.
  static bool postpones(int signal);
};

}  // namespace rigcal
