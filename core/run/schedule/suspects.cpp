#include "core/run/schedule/suspects.hpp"

namespace lightnet {

bool Suspects::blame(WorkId work, const Loss& loss) {
    losses_[work].push_back(loss);
    return died_alone(work).size() >= deaths_alone_;
}

std::vector<Suspects::Host> Suspects::died_alone(WorkId work) const {
    std::vector<Host> hosts;
    if (const auto found = losses_.find(work); found != losses_.end())
        for (const auto& loss : found->second)
            if (loss.alone) hosts.push_back(loss.host);
    return hosts;
}

void Suspects::lost(Host host, std::uint64_t process) {
    if (process) lost_.insert({host, process});
}

std::vector<Suspects::WorkId> Suspects::came_back(Host host, std::uint64_t process) {
    std::vector<WorkId> clear;
    if (lost_.erase({host, process}) == 0) return clear;
    std::set<WorkId> acquitted;
    for (auto entry = losses_.begin(); entry != losses_.end();) {
        std::erase_if(entry->second, [&](const Loss& loss) { return loss.host == host && loss.process == process; });
        if (!entry->second.empty()) {
            ++entry;
            continue;
        }
        acquitted.insert(entry->first);
        entry = losses_.erase(entry);
    }
    std::erase_if(queue_, [&](WorkId work) {
        if (!acquitted.contains(work)) return false;
        clear.push_back(work);
        return true;
    });
    return clear;
}

}  // namespace lightnet
