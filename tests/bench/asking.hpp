// A node that asks another as fast as it can, for benchmarks of what lies between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/network/graph/kind.hpp"
#include "core/network/graph/plan.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/message/carrier.hpp"
#include "tests/bench/picture.hpp"
#include "tests/bench/plain_pair.hpp"

namespace lightnet::bench {

inline constexpr std::size_t asked_together = 256;  // questions in a bundle
inline constexpr std::uint64_t asking_run = 1;

Registry asking_kinds();
/// So many questions in a bundle.
Job asking_job(const Picture& picture, std::size_t together = asked_together);
/// The first place asks the second.
Plan one_asks_the_other(const PlaceAt& first, const PlaceAt& second);

/// On the wall clock, there and back, of many that are under way at the same time.
double seconds_of_bundle(Carrier& carrier, const Plan& plan);
double seconds_of_plain_bundle(PlainPair& plain);

/// A figure, and the plain way that it is measured beside.
struct Beside {
    std::string name;
    PlainLoad load;
    PlainLine line = PlainLine::open;
    bool costs = false;  // figures of what a bundle costs, too
};
/// The full way and plain ones in turns, whose endpoints are those of `plain_endpoint`.
void measure_asking(Carrier& carrier, const Plan& plan, const std::function<std::string(std::size_t)>& plain_endpoint,
                    const std::vector<Beside>& besides, std::size_t together = asked_together);

}  // namespace lightnet::bench
