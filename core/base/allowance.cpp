#include "core/base/allowance.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/this_machine.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

// A folder of the tree of control groups for a controller ("cpu"), and whether it is of their second version.
struct GroupFolder {
    fs::path path;
    bool second = true;
};

bool has_word(const std::string& words, std::string_view wanted) {
    std::istringstream in(words);
    for (std::string word; std::getline(in, word, ',');)
        if (word == wanted) return true;
    return false;
}

// The group and all around it, up to the root: each may set a limit, and inside of a container the path can be one that
// only the outside knows.
void add_with_parents(std::vector<GroupFolder>& folders, const fs::path& root, const std::string& group, bool second) {
    for (fs::path at = fs::path(group).relative_path().lexically_normal();; at = at.parent_path()) {
        if (at.empty() || *at.begin() != "..") folders.push_back({root / at, second});
        if (at.empty()) return;
    }
}

// Lines of /proc/self/cgroup: "4:cpu,cpuacct:/some/group", or "0::/some/group" of the second version.
std::vector<GroupFolder> groups_of(const SystemFiles& files, std::string_view controller) {
    std::vector<GroupFolder> folders;
    const fs::path root = files.groups;
    std::ifstream in(fs::path(files.proc) / "self/cgroup");
    for (std::string line; std::getline(in, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const auto names = line.substr(first + 1, second - first - 1), group = line.substr(second + 1);
        if (names.empty()) {
            add_with_parents(folders, root, group, true);
            add_with_parents(folders, root / "unified", group, true);  // where both versions are in use
        } else if (has_word(names, controller)) {
            add_with_parents(folders, root / names, group, false);
            if (names != controller) add_with_parents(folders, root / controller, group, false);
        }
    }
    if (folders.empty()) folders = {{root, true}, {root / controller, false}};
    return folders;
}

std::optional<double> number_in(const fs::path& file) {
    std::ifstream in(file);
    double number = 0;
    return in >> number ? std::optional(number) : std::nullopt;  // "max" is none
}

std::optional<double> quota_in(const GroupFolder& folder) {
    double quota = 0, period = 0;
    if (folder.second) {
        std::ifstream in(folder.path / "cpu.max");
        if (!(in >> quota >> period)) return std::nullopt;
    } else {
        quota = number_in(folder.path / "cpu.cfs_quota_us").value_or(-1);  // -1: none
        period = number_in(folder.path / "cpu.cfs_period_us").value_or(0);
    }
    return quota > 0 && period > 0 ? std::optional(quota / period) : std::nullopt;
}

using Limit = std::optional<double>;
Limit less_of(Limit a, Limit b) { return a && b ? std::min(a, b) : a ? a : b; }

Limit least_of_groups(const SystemFiles& files, std::string_view controller,
                      const std::function<Limit(const GroupFolder&)>& limit) {
    Limit least;
    for (const auto& folder : groups_of(files, controller)) least = less_of(least, limit(folder));
    return least;
}

// The cores that the scheduler gives to this process. The set is as large as the system says, which may be more than
// cpu_set_t has room for.
unsigned cores_bound_to(unsigned all) {
    constexpr int most = 1 << 16;
    for (int room = 1024; room <= most; room *= 2) {
        const std::unique_ptr<cpu_set_t, void (*)(cpu_set_t*)> set(CPU_ALLOC(room),
                                                                   [](cpu_set_t* it) { CPU_FREE(it); });
        const auto size = CPU_ALLOC_SIZE(room);
        if (set && sched_getaffinity(getpid(), size, set.get()) == 0)
            return std::max(1u, static_cast<unsigned>(CPU_COUNT_S(size, set.get())));
    }
    return all;
}

// "4", or "4,2" for teams within teams: the first.
std::optional<unsigned> number_of_variable(const char* name) {
    const char* const text = std::getenv(name);
    if (!text) return std::nullopt;
    unsigned number = 0;
    const std::string_view all(text);
    const auto [end, fault] = std::from_chars(all.data(), all.data() + all.size(), number);
    const bool whole = end == all.data() + all.size() || *end == ',';
    return fault == std::errc{} && whole && number > 0 ? std::optional(number) : std::nullopt;
}

}  // namespace

unsigned CoreAllowance::cores() const {
    double least = std::min(machine, bound);
    if (quota) least = std::min(least, std::ceil(*quota - 1e-9));
    if (asked) least = std::min(least, double{1} * *asked);
    return std::max(1u, static_cast<unsigned>(least));
}

CoreAllowance core_allowance(const SystemFiles& files) {
    CoreAllowance allowance;
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    allowance.machine = online > 0 ? static_cast<unsigned>(online) : std::max(1u, std::thread::hardware_concurrency());
    allowance.bound = cores_bound_to(allowance.machine);
    allowance.quota = least_of_groups(files, "cpu", quota_in);
    for (const char* name : {"OMP_NUM_THREADS", "OMP_THREAD_LIMIT"})
        if (const auto number = number_of_variable(name))
            allowance.asked = std::min(*number, allowance.asked.value_or(*number));
    return allowance;
}

unsigned usable_cores() {
    static const unsigned cores = core_allowance().cores();
    return cores;
}

std::optional<std::uint64_t> memory_of_group(const SystemFiles& files) {
    const auto limit = least_of_groups(files, "memory", [](const GroupFolder& folder) {
        return number_in(folder.path / (folder.second ? "memory.max" : "memory.limit_in_bytes"));
    });
    constexpr double none = 1e18;  // what the first version says when there is no limit is a little less than 2^63
    return limit && *limit < none ? std::optional(static_cast<std::uint64_t>(*limit)) : std::nullopt;
}

std::optional<std::uint64_t> threads_of_group(const SystemFiles& files) {
    const auto limit =
        least_of_groups(files, "pids", [](const GroupFolder& folder) { return number_in(folder.path / "pids.max"); });
    return limit ? std::optional(static_cast<std::uint64_t>(*limit)) : std::nullopt;
}

std::uint64_t usable_memory(const SystemFiles& files) {
    const auto all = machine_memory(), group = memory_of_group(files).value_or(all);
    return all ? std::min(all, group) : group;
}

}  // namespace lightnet
