#include "tools/trials/trial_runs.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/own_process.hpp"
#include "core/run/assembly/prepared.hpp"
#include "tools/session/handover.hpp"
#include "tools/session/run.hpp"
#include "tools/session/run_figures.hpp"
#include "tools/support/signals.hpp"

namespace lightnet {
namespace {

/// Signals of a run that nobody wants any more when this process has computed for so long, or a signal has come.
class Limit {
public:
    explicit Limit(double seconds)
        : end_(processor_seconds() + seconds), thread_([this](const std::stop_token& stop) { wait(stop); }) {}

    const Signals& signals() const { return signals_; }

private:
    void wait(const std::stop_token& stop) {
        constexpr std::chrono::milliseconds often(10);  // handlers of signals can't wake others
        std::unique_lock lock(mutex_);
        while (!stop.stop_requested() && !watch_signals().any && processor_seconds() < end_)
            ended_.wait_for(lock, stop, often, [] { return false; });
        if (stop.stop_requested()) return;
        signals_.superseded = true;
        signals_.any = true;
    }

    double end_;
    Signals signals_;
    std::mutex mutex_;
    std::condition_variable_any ended_;
    std::jthread thread_;  // last: it uses the rest
};

}  // namespace

struct TrialRuns::Shared {
    explicit Shared(const Registry& all) : registry(all) { handover.results = std::make_shared<ResultsAtHand>(); }

    const Registry& registry;
    Handover handover{};
};

TrialRuns::TrialRuns(const Registry& registry) : shared_(new Shared(registry)) {}
TrialRuns::~TrialRuns() = default;

int TrialRuns::run(const RunRequest& request, double seconds) {
    const Limit limit(seconds);
    return lightnet::run(request, shared_->registry, &shared_->handover, limit.signals());
}

int TrialRuns::run_to_end(const RunRequest& request) {
    shared_->handover.say_again();
    // What nobody asks for need not lie in memory.
    if (preparing_nodes(request.graph, shared_->registry).empty()) shared_->handover.results.reset();
    return lightnet::run(request, shared_->registry, &shared_->handover);
}

}  // namespace lightnet
