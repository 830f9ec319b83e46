#include "transport/launcher/host_wait.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "core/base/error.hpp"
#include "transport/launcher/remote_host.hpp"

namespace lightnet {

HostWait::Verdict HostWait::look(const Standing& standing, Time now) {
    const auto waited = now - begun_;
    if (standing.ready && !first_ready_) first_ready_ = now;
    // Machines differ: whoever is not ready gets as long again as the first one took.
    const bool too_slow =
        first_ready_ && now - *first_ready_ > std::max<Time::duration>(patience_.slow, *first_ready_ - begun_);
    if (patience_.most && waited >= *patience_.most && !standing.ready)
        return standing.busy ? Verdict::nobody_free : Verdict::nobody;
    if (patience_.most && waited >= *patience_.most) return Verdict::begin;
    if (standing.pending && !too_slow && (standing.ready || standing.files_arrive || waited < patience_.build))
        return Verdict::wait;
    if (waited < patience_.absent && (standing.absent || standing.busy)) return Verdict::wait;
    if (standing.ready) return Verdict::begin;
    if (standing.pending) return Verdict::nobody;
    // Others will be free at some time.
    if (standing.busy) return patience_.busy && waited >= *patience_.busy ? Verdict::nobody_free : Verdict::wait;
    return waited >= patience_.nobody || !standing.others_may_come ? Verdict::nobody : Verdict::wait;
}

bool HostWait::should_speak(Time now) {
    if (now < next_words_) return false;
    next_words_ = now + pause_;
    if (now - begun_ > 6 * pause_) pause_ = std::min(2 * pause_, longest_);
    return true;
}

void ExpectedHosts::look(const HostWait::Standing& standing, Time now) {
    if (why_ && !standing.ready && !may_come(standing, now)) throw Error(*why_);
    if (standing.ready) why_.reset();
}

void throw_if_broken(const std::vector<std::unique_ptr<HostLink>>& links, bool nobody_left) {
    std::map<std::string, const HostLink*> reasons;
    for (const auto& link : links) {
        if (!link->broken() || link->state() != HostLink::State::refused) continue;
        const bool fresh = reasons.emplace(link->reason(), link.get()).second;
        if (!fresh || nobody_left) throw Error(link->name(), link->reason());
    }
}

}  // namespace lightnet
