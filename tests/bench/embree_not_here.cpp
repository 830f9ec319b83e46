// Stands for embree.cpp, which takes the place of functions that newer versions of Embree don't have.
#include "tests/bench/figure.hpp"

int main() {
    for (const char* name : {"embree.cornell", "embree.terrain"}) lightnet::bench::not_run(name, "it wants Embree 3");
}
