#include "core/base/own_process.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <system_error>

namespace lightnet {
namespace {

// Behind the name of the program, which may hold anything: fields 3 and following of /proc/self/stat.
struct Stat {
    std::uint64_t threads = 0;
    double started = 0;  // ticks since the machine was
    std::uint64_t virtually = 0, resident_pages = 0;
};

Stat own_stat() {
    std::ifstream file("/proc/self/stat");
    std::string text;
    std::getline(file, text, '\0');  // a name may have several lines; what can't be read is as good as empty
    const auto end = text.rfind(')');
    Stat stat;
    if (end == std::string::npos) return stat;
    std::istringstream in(text.substr(end + 1));
    std::string skipped;
    for (int field = 3; field < 20; ++field) in >> skipped;
    in >> stat.threads >> skipped >> stat.started >> stat.virtually >> stat.resident_pages;
    return stat;
}

double machine_started() {
    std::ifstream in("/proc/stat");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("btime ")) return std::stod(line.substr(6));
    return 0;
}

std::uint64_t open_descriptors() {
    std::error_code fault;
    std::uint64_t count = 0;
    for (auto at = std::filesystem::directory_iterator("/proc/self/fd", fault);
         !fault && at != std::filesystem::directory_iterator(); at.increment(fault))
        ++count;
    return count ? count - 1 : 0;  // the one to look with
}

}  // namespace

// /proc/self/stat counts in ticks of 10 ms: a process that has just begun would have taken nothing.
double processor_seconds() {
    timespec taken{};
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &taken) != 0) return 0;
    return static_cast<double>(taken.tv_sec) + static_cast<double>(taken.tv_nsec) * 1e-9;
}

ProcessFigures process_figures() {
    const auto stat = own_stat();
    const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
    ProcessFigures figures;
    figures.resident = stat.resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    figures.virtually = stat.virtually;
    figures.threads = stat.threads;
    figures.processor_seconds = processor_seconds();
    if (ticks > 0 && stat.started > 0) figures.started = machine_started() + stat.started / ticks;
    figures.descriptors = open_descriptors();
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        figures.most_descriptors = limit.rlim_cur;
    return figures;
}

std::chrono::nanoseconds thread_ready_time() {
    std::ifstream in("/proc/thread-self/schedstat");
    std::uint64_t ran = 0, ready = 0;
    if (!(in >> ran >> ready)) return {};
    return std::chrono::nanoseconds(ready);
}

std::uint64_t own_threads() { return own_stat().threads; }

std::uint64_t peak_memory() {
    std::ifstream in("/proc/self/status");
    for (std::string word; in >> word; in.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
        if (std::uint64_t kilobytes = 0; word == "VmHWM:" && in >> kilobytes) return kilobytes * 1024;
    rusage usage{};
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::uint64_t>(usage.ru_maxrss) * 1024 : 0;
}

bool forget_peak_memory() {
    std::ofstream out("/proc/self/clear_refs");
    return static_cast<bool>(out << "5" << std::flush);
}

}  // namespace lightnet
