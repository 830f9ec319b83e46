#include "tools/daemon/memory_bound.hpp"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>
#include <tuple>

namespace lightnet {
namespace {

// Who waits looks around, too, and answers heartbeats: some thousandths of a processor.
constexpr int idle_below = 20;  // 1 / 20 of a processor

// Files that are mapped are the system's to drop.
std::uint64_t own_memory(std::istream& status) {
    std::uint64_t all = 0;
    for (std::string line; std::getline(status, line);) {
        std::istringstream in(line);
        std::string name;
        std::uint64_t kibibytes = 0;
        if (in >> name >> kibibytes && (name == "RssAnon:" || name == "RssShmem:" || name == "VmSwap:"))
            all += kibibytes << 10;
    }
    return all;
}

// Fields 14 and 15, behind the name of the program, which may hold anything.
std::chrono::milliseconds computed(const std::string& stat) {
    const auto end = stat.rfind(')');
    if (end == std::string::npos) return {};
    std::istringstream in(stat.substr(end + 1));
    std::string skipped;
    for (int field = 3; field < 14; ++field) in >> skipped;
    long user = 0, system = 0;
    in >> user >> system;
    return std::chrono::milliseconds((user + system) * 1000 / sysconf(_SC_CLK_TCK));
}

}  // namespace

std::optional<ProcessUse> use_of(int process) {
    const auto folder = "/proc/" + std::to_string(process);
    std::ifstream status(folder + "/status"), stat_file(folder + "/stat");
    std::string stat;
    if (!status || !std::getline(stat_file, stat, '\0')) return std::nullopt;
    return ProcessUse{own_memory(status), computed(stat)};
}

void MemoryBound::note_work(const std::vector<std::optional<ProcessUse>>& all, Time now) {
    seen_.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        auto& seen = seen_[i];
        if (!all[i]) {
            seen.reset();
            continue;
        }
        const bool works = !seen || (all[i]->computed - seen->computed) * idle_below > now - seen->at;
        seen = Seen{all[i]->computed, now, works ? now : seen->worked};
    }
}

std::optional<MemoryBound::Verdict> MemoryBound::look(const std::vector<std::optional<ProcessUse>>& all, Time now) {
    note_work(all, now);
    std::uint64_t together = 0;
    for (const auto& one : all) together += one ? one->memory : 0;
    if (together <= most_) return std::nullopt;
    std::optional<Verdict> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i] || all[i]->memory * all.size() <= most_) continue;
        const auto idle = std::chrono::duration_cast<std::chrono::seconds>(now - seen_[i]->worked);
        if (!found || std::tuple(idle, all[i]->memory) > std::tuple(found->idle, found->its))
            found = Verdict{i, together, all[i]->memory, idle};
    }
    return found;
}

}  // namespace lightnet
