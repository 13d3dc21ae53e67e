#pragma once

namespace rigcal::test {

/// Whether AddressSanitizer watches, which takes ten times longer: what is a matter of many draws
/// or of a long record is then shown with fewer. The optimised build shows it in full.
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
