// What the framework costs: serial, threaded and networked runs beside loops that do without it. All figures are ratios
// of what was measured in turns, in one run; medians over the rounds.
// Arguments: serial, threads, network; without any, all of them.
#include "tests/bench/overhead.hpp"
#include "tests/bench/figure.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string_view>

#include "nodes/standard_nodes.hpp"

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const auto wanted = [&](std::string_view group) {
        return argc == 1 || std::any_of(argv + 1, argv + argc, [&](const char* word) { return group == word; });
    };
    return lightnet::bench::run("overhead", [&] {
        const lightnet::Registry registry{lightnet::standard_nodes()};
        const bench::Picture small(registry, bench::sized(128u, 32u), bench::sized(16u, 1u)),
            large(registry, bench::sized(256u, 64u), bench::sized(32u, 1u));
        if (wanted("serial")) bench::measure_serial(small);
        if (wanted("threads")) bench::measure_threads(large, registry);
        if (wanted("network")) bench::measure_network(large, registry);
    });
}
