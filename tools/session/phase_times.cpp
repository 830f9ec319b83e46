#include "tools/session/phase_times.hpp"

#include <utility>

#include "tools/session/run_figures.hpp"

namespace lightnet {
namespace {

double seconds_between(PhaseTimes::Time from, PhaseTimes::Time to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void PhaseTimes::begin(const std::string& name, Time now) {
    end(now);
    report_.phases.push_back({name, 0, seconds_of_this_thread()});
    begun_ = now;
}

void PhaseTimes::end(Time now) {
    end_doing(now);
    if (begun_) {
        auto& phase = report_.phases.back();
        phase.seconds = seconds_between(*begun_, now);
        phase.processor = seconds_of_this_thread() - phase.processor;
    }
    begun_.reset();
}

bool PhaseTimes::preparing(const PrepareProgress& progress, Time now) {
    const bool another = std::exchange(last_prepared_, progress.node) != progress.node;
    auto& did = report_.preparing;
    if (doing_since_ && did.back().node == progress.node && did.back().what == progress.what) return another;
    end_doing(now);
    if (progress.what.empty()) return another;
    did.push_back({progress.node, progress.what, 0});
    doing_since_ = now;
    return another;
}

void PhaseTimes::end_doing(Time now) {
    if (doing_since_) report_.preparing.back().seconds = seconds_between(*doing_since_, now);
    doing_since_.reset();
}

}  // namespace lightnet
