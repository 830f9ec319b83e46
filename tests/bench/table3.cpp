// The paper's Table 3: functional and data parallelism at once. The network of its figure 5 on three hosts with 4, 2
// and 1 processors, laid out as graphs/paper/hosts/table3.lua says: operators that cost differently, on hosts that have
// differently many of them. Nothing is dealt out evenly; who answers what follows from where the questions go.
//
// Both figures are the work of all operators, over the time that it took and all processors.
#include "tests/bench/table3.hpp"

#include <string>
#include <vector>

#include "tests/bench/figure.hpp"
#include "tests/bench/paper.hpp"

namespace lightnet::bench {
namespace {

const std::size_t tiles = sized<std::size_t>(600, 20);
// The lighting asks each of its inputs, and so does `first`, whom the cache asks.
const EmulatedCosts costs{{{"image", 10}, {"direct", 10}, {"caustics", 30}, {"global", 30}, {"soft", 20}}, 256};

}  // namespace

void measure_emulated_hosts() {
    const std::vector<std::uint32_t> places(table3_places.begin(), table3_places.end());
    figure("table3.emulated", emulated_efficiency("figure5", "table3", places, costs, tiles), 0.9, true);
}

}  // namespace lightnet::bench

int main(int argc, char** argv) {
    const std::string only = argc > 1 ? argv[1] : "";
    return lightnet::bench::run("table3", [&] {
        if (only.empty() || only == "emulated") lightnet::bench::measure_emulated_hosts();
        if (only.empty() || only == "real") lightnet::bench::measure_real_hosts();
    });
}
