// What uses up a stack.
#pragma once

namespace lightnet::test {

/// Calls itself without end, in a way that no compiler can turn into a loop.
inline int recurse(const int* before) {
    int here[256];
    here[0] = before ? *before + 1 : 0;
    if (here[0] < 0) return 0;
    const int below = recurse(here);
    return below + here[0];
}

}  // namespace lightnet::test
