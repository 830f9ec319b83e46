// Where the processor time of a process goes, by the names of its threads.
#pragma once

#include <map>
#include <string>

namespace lightnet::bench {

/// Seconds by name without its number, "place" for "place 3", of threads that are there now.
using ThreadTimes = std::map<std::string, double>;
ThreadTimes thread_times(int process);
ThreadTimes operator-(ThreadTimes after, const ThreadTimes& before);
/// "place 3.21, dispatcher .12", most first.
std::string text_of(const ThreadTimes& times);

}  // namespace lightnet::bench
