// What a thing done costs the system: numbers that hardly depend on what else the machine does.
#pragma once

namespace lightnet::bench {

/// Of this process, all threads, since it began; or of one thing done.
struct Costs {
    double calls = 0;     // of the system, by who sends, receives and waits: read, write, send, recv, poll, epoll
    double switches = 0;  // of threads, by their own will or not
    double seconds = 0;   // of processor time
};
Costs costs_so_far();
/// Each of so many.
Costs costs_since(const Costs& before, double count);

}  // namespace lightnet::bench
