// Sanitizers slow everything down; bounds on time in tests take it into account.
#pragma once

namespace lightnet::test {

/// How many times longer things may take than in an ordinary build.
#if defined(__SANITIZE_THREAD__)
inline constexpr int slowdown = 8;
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr int slowdown = 4;
#else
inline constexpr int slowdown = 1;
#endif

}  // namespace lightnet::test
