#include "tools/hosts/doctor.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/allowance.hpp"
#include "core/base/build_info.hpp"
#include "core/base/error.hpp"
#include "core/base/joined.hpp"
#include "core/base/this_machine.hpp"
#include "core/base/words_of.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "transport/launcher/probe_hosts.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/wire/pass.hpp"
#include "transport/zmq/zmq_hosts.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;
using Grade = Finding::Grade;

constexpr double bytes_per_gib = 1 << 30;

// As many as runs and daemons take by themselves, and who says that they are no more.
Finding look_at_cores() {
    const auto allowance = core_allowance();
    const auto cores = allowance.cores();
    std::vector<std::string> why;
    if (allowance.bound < allowance.machine) why.push_back(fmt::format("this process is bound to {}", allowance.bound));
    if (allowance.quota && *allowance.quota < allowance.machine)
        why.push_back(fmt::format("the control group gives {:.1f}", *allowance.quota));
    if (allowance.asked && *allowance.asked < allowance.machine)
        why.push_back(fmt::format("OMP_NUM_THREADS or OMP_THREAD_LIMIT says {}", *allowance.asked));
    if (why.empty()) return {Grade::good, "cores", std::to_string(cores), ""};
    return {Grade::good, "cores", fmt::format("{} of {}: {}", cores, allowance.machine, joined(why, ", ")), ""};
}

Finding look_at_memory() {
    const double all = static_cast<double>(machine_memory());
    double left = 0;
    std::ifstream in("/proc/meminfo");
    for (std::string name; in >> name;)
        if (name == "MemAvailable:" && in >> left) break;
    left *= 1024;
    std::string what = fmt::format("{:.1f} GiB, {:.1f} free", all / bytes_per_gib, left / bytes_per_gib);
    if (const auto limit = memory_of_group(); limit && static_cast<double>(*limit) < all)
        what += fmt::format(", the control group gives {:.1f}", static_cast<double>(*limit) / bytes_per_gib);
    if (left > 0 && left < bytes_per_gib)
        return {Grade::doubtful, "memory", what,
                "a scene of a million triangles takes about half a GiB: end something else"};
    return {Grade::good, "memory", what, ""};
}

Finding look_at_rays() {
    const std::string isa = usual_isa();
    try {
        return {Grade::good, "rays", fmt::format("Embree with {}, fingerprint {:016x}", isa, fingerprint(isa)), ""};
    } catch (const std::exception& error) {
        return {Grade::bad, "rays", words_of(error), "lightnet needs a processor with SSE 4.2"};
    }
}

Finding look_at_limit(__rlimit_resource which, const char* about, std::uint64_t wanted, const char* advice) {
    rlimit limit{};
    getrlimit(which, &limit);
    const bool enough = limit.rlim_max == RLIM_INFINITY || limit.rlim_max >= wanted;
    return {enough ? Grade::good : Grade::doubtful, about,
            limit.rlim_max == RLIM_INFINITY ? "unlimited" : fmt::format("at most {}", limit.rlim_max),
            enough ? "" : advice};
}

Finding look_at_threads() {
    if (const auto most = threads_of_group(); most && *most < 600)
        return {Grade::doubtful, "threads", fmt::format("at most {} of the control group", *most),
                "give it 600 (TasksMax of a unit)"};
    return look_at_limit(RLIMIT_NPROC, "threads", 600, "raise it: ulimit -u 600");
}

Finding look_at_ports() {
    try {
        zmq_hosts()->listen("tcp://127.0.0.1:*", std::nullopt);
        return {Grade::good, "ports", "a daemon can listen on loopback", ""};
    } catch (const std::exception& error) {
        return {Grade::bad, "ports", "nothing can listen on loopback: " + words_of(error),
                "see that 127.0.0.1 is up (ip link set lo up)"};
    }
}

Finding look_at_cache(const std::string& named) try {
    const std::string folder = named.empty() ? default_cache_folder() : named;
    open_cache_folder(folder);
    std::uint64_t size = 0;
    for (const auto& file : files_of_ours(folder)) size += file.size;
    const double left = static_cast<double>(fs::space(folder).available);
    const std::string what =
        fmt::format("{}: {:.2f} GiB, {:.1f} GiB free beside it", folder, size / bytes_per_gib, left / bytes_per_gib);
    if (::access(folder.c_str(), W_OK) != 0)
        return {Grade::bad, "cache", what, "it can't be written: choose another (--cache FOLDER)"};
    return {left < bytes_per_gib ? Grade::doubtful : Grade::good, "cache", what,
            left < bytes_per_gib ? "make room, or take a folder on another disk (--cache FOLDER)" : ""};
} catch (const std::exception& error) {
    return {Grade::bad, "cache", words_of(error), "choose another folder: --cache FOLDER"};
}

Finding look_at_pass() try {
    const std::string file = Pass::usual_file();
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0)
        return {Grade::good, "pass", file + " is not there yet: the first run with --listen makes it", ""};
    if (status.st_mode & 077)
        return {Grade::bad, "pass", file + " can be read by others",
                "chmod 600 " + file + ", and make it anew if they may have"};
    return {Grade::good, "pass", file, ""};
} catch (const std::exception& error) {
    return {Grade::doubtful, "pass", words_of(error), "say where it is: --pass FILE"};
}

// "0.2.0 (GNU 12.2.0, x86-64-v2, …)" in its parts, with what each is.
std::vector<std::pair<std::string, std::string>> parts_of_build(const std::string& build) {
    static const std::vector<std::string> names{"compiler", "instruction set", "kind of build",
                                                "Embree",   "flags",           "sources"};
    const auto bracket = build.find(" (");
    std::vector<std::pair<std::string, std::string>> parts{{"version", build.substr(0, bracket)}};
    if (bracket == std::string::npos) return parts;
    std::istringstream rest(build.substr(bracket + 2, build.size() - bracket - 3));
    std::size_t at = 0;
    for (std::string part; std::getline(rest >> std::ws, part, ',') && at < names.size(); ++at) {
        const std::string& name = names[at];
        parts.push_back({name, part.starts_with(name + " ") ? part.substr(name.size() + 1) : part});
    }
    return parts;
}

Finding look_at_host(const HostProbe& probe, const std::string& build) {
    const auto& answer = probe.answer;
    if (!answer.answers)
        return {Grade::bad, answer.asked, answer.state,
                !answer.advice.empty()
                    ? answer.advice
                    : "is lightnetd there, does it listen beyond its loopback, does a firewall let the port through?"};
    std::string what = fmt::format("{}, {} places, round trip {:.2f} ms", answer.state, answer.places,
                                   std::chrono::duration<double, std::milli>(probe.round_trip).count());
    if (probe.bandwidth > 0) what += fmt::format(", {:.0f} MB/s", probe.bandwidth / 1e6);
    if (!probe.plugins.empty()) what += ", plugins " + probe.plugins;
    Finding finding{Grade::good, answer.asked, what, ""};
    if (probe.clock_ahead) {
        const double seconds = std::chrono::duration<double>(*probe.clock_ahead).count();
        finding.what += fmt::format(", its clock {:+.3f} s", seconds);
        if (std::fabs(seconds) > 1)
            finding.grade = Grade::doubtful,
            finding.advice = "pictures don't mind, logs do: let a time server set both";
    }
    if (const auto differ = difference_of_builds(answer.machine.version, build); !differ.empty()) {
        finding.grade = Grade::bad;
        finding.advice = "it is another build, and would be refused: " + differ + ". Install the same package on both";
    }
    return finding;
}

}  // namespace

std::string difference_of_builds(const std::string& theirs, const std::string& ours) {
    if (theirs == ours) return {};
    const auto there = parts_of_build(theirs), here = parts_of_build(ours);
    std::string text;
    for (std::size_t i = 0; i < std::min(there.size(), here.size()); ++i)
        if (there[i].second != here[i].second)
            text += (text.empty() ? "" : "; ") + here[i].first + " " + there[i].second + ", here " + here[i].second;
    return text.empty() ? theirs + ", here " + ours : text;
}

std::vector<Finding> look_at_this_machine(const std::string& cache) {
    return {{Grade::good, "build", build_id(), ""},
            look_at_cores(),
            look_at_memory(),
            look_at_rays(),
            look_at_limit(RLIMIT_NOFILE, "descriptors", 4096, "raise it: ulimit -n 65536, or LimitNOFILE of a unit"),
            look_at_threads(),
            look_at_ports(),
            look_at_cache(cache),
            look_at_pass()};
}

std::vector<Finding> look_at_hosts(const std::vector<HostProbe>& probes, const std::string& build) {
    std::vector<Finding> findings;
    for (const auto& probe : probes) findings.push_back(look_at_host(probe, build));
    return findings;
}

std::string findings_table(const std::vector<Finding>& findings) {
    std::size_t width = 0;
    for (const auto& finding : findings) width = std::max(width, finding.about.size());
    std::string text;
    for (const auto& finding : findings) {
        const char* grade = finding.grade == Grade::good ? "ok" : finding.grade == Grade::doubtful ? "?" : "!";
        text += fmt::format("{:<2}  {:<{}}  {}\n", grade, finding.about, width, finding.what);
        if (!finding.advice.empty()) text += fmt::format("    {:<{}}  -> {}\n", "", width, finding.advice);
    }
    return text;
}

bool all_good_enough(const std::vector<Finding>& findings) {
    return std::none_of(findings.begin(), findings.end(),
                        [](const Finding& finding) { return finding.grade == Grade::bad; });
}

}  // namespace lightnet
