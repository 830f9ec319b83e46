// Exit codes of our programs.
#pragma once

namespace lightnet::exit_code {

inline constexpr int done = 0;
inline constexpr int failed = 1;       // the run
inline constexpr int usage = 2;        // command line, graph or scene
inline constexpr int no_worker = 3;    // none reachable, or none free in time: it may be worth to come again
inline constexpr int unknown_key = 4;  // workers are there, but they and we don't know each other
inline constexpr int other_build = 5;  // `hosts`: a daemon is there that would be refused, as its build is another
inline constexpr int interrupted = 130;

}  // namespace lightnet::exit_code
