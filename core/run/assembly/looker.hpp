// Looks at places at work, many times a second.
#pragma once

#include <memory>
#include <vector>

#include "core/run/assembly/gauge.hpp"
#include "core/run/message/figures.hpp"

namespace lightnet {

/// A thread that does nothing else: places neither wait for it nor look at a clock for it. What a place is found at,
/// over many looks, is how it spends its time.
class Looker {
public:
    /// The gauges outlive it; one for each place.
    explicit Looker(std::vector<const Gauge*> gauges);
    ~Looker();
    Looker(const Looker&) = delete;
    Looker& operator=(const Looker&) = delete;

    /// So far. Any thread.
    HostFigures figures() const;

private:
    struct Tally;
    std::unique_ptr<Tally> tally_;
};

}  // namespace lightnet
