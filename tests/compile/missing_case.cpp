// Compiled by the tests "compile: ...": with all cases it has to compile, with one missing it must
// not.

enum class State { good, bad };

const char* words(State state);
const char* words(State state) {
  switch (state) {
    case State::good:
      return "good";
#ifdef ALL_CASES
    case State::bad:
      return "bad";
#endif
  }
  return "";
}
