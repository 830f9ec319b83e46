// Looks at places at work, many times a second.
#pragma once

#include <memory>
#include <vector>

#include "core/run/assembly/gauge.hpp"
#include "core/run/message/figures.hpp"

namespace lightnet {

/// A thread that does nothing else: places neither wait for it nor look at a clock for it. What a place is found at,
/// over many looks, is how it spends its time.
class SamplingProfiler {
public:
    /// The gauges outlive it; one for each place.
    explicit SamplingProfiler(std::vector<const Gauge*> gauges);
    ~SamplingProfiler();
    SamplingProfiler(const SamplingProfiler&) = delete;
    SamplingProfiler& operator=(const SamplingProfiler&) = delete;

    /// So far. Any thread.
    HostFigures figures() const;

private:
    struct Tally;
    std::unique_ptr<Tally> tally_;
};

}  // namespace lightnet
