#include "tests/bench/processor_group.hpp"

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;

// So short that nobody notices that it runs for a part of it and stands still for the rest.
constexpr int period_us = 10'000;

bool write_to(const fs::path& file, const std::string& text) {
    std::ofstream out(file);
    out << text << std::flush;
    return out.good();
}

// So heavy that other programs take nothing of it.
void put_before_others(const fs::path& group) {
    write_to(group / (fs::exists(group / "cpu.max") ? "cpu.weight" : "cpu.shares"),
             fs::exists(group / "cpu.max") ? "10000" : "262144");
}

// In either version of control groups.
bool limit(const fs::path& group, int quota_us) {
    if (fs::exists(group / "cpu.max"))
        return write_to(group / "cpu.max", std::to_string(quota_us) + " " + std::to_string(period_us));
    return fs::exists(group / "cpu.cfs_quota_us") && write_to(group / "cpu.cfs_period_us", std::to_string(period_us)) &&
           write_to(group / "cpu.cfs_quota_us", std::to_string(quota_us));
}

}  // namespace

ProcessorGroup::ProcessorGroup(const std::string& name, double processors) {
    for (const fs::path root : {"/sys/fs/cgroup/cpu", "/sys/fs/cgroup"}) {
        const fs::path group = root / ("lightnet-" + std::to_string(getpid()) + "-" + name);
        std::error_code error;
        if (!fs::create_directory(group, error)) continue;
        if (limit(group, static_cast<int>(processors * period_us))) {
            path_ = group;
            put_before_others(group);
            return;
        }
        rmdir(group.c_str());
    }
}

// It takes a moment until the last process is out.
ProcessorGroup::~ProcessorGroup() {
    for (int i = 0; i < 100 && there() && rmdir(path_.c_str()) != 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

void ProcessorGroup::take(int process) const {
    if (!write_to(path_ / "cgroup.procs", std::to_string(process)))
        throw std::runtime_error("a process can't be put into " + path_.string());
}

}  // namespace lightnet::bench
