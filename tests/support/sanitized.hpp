#pragma once

namespace rigcal::test {

/// Whether the build uses AddressSanitizer, which makes it ten times slower. Tests with many draws
/// or long records then use fewer or shorter ones. The optimised build runs them in full.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace rigcal::test
