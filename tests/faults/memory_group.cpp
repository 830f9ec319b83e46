#include "tests/faults/memory_group.hpp"

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace lightnet::test {

std::vector<std::filesystem::path> memory_groups(int process) {
    const auto name = "lightnet-" + std::to_string(process);
    return {std::filesystem::path("/sys/fs/cgroup/memory") / name, std::filesystem::path("/sys/fs/cgroup") / name};
}

MemoryGroup::MemoryGroup() {
    for (const auto& path : memory_groups(getpid())) {
        std::error_code error;
        if (!std::filesystem::create_directory(path, error)) continue;
        path_ = path;
        for (const auto* name : {"memory.limit_in_bytes", "memory.max"})
            if (std::filesystem::exists(path / name)) limit_ = path / name;
        for (const auto* name : {"memory.usage_in_bytes", "memory.current"})
            if (std::filesystem::exists(path / name)) usage_ = path / name;
        if (!limit_.empty()) return;
        leave();
    }
}

double MemoryGroup::usage() const {
    double bytes = 0;
    std::ifstream(usage_) >> bytes;
    return bytes;
}

bool MemoryGroup::limit(double bytes) const {
    std::ofstream file(limit_);
    file << static_cast<long long>(bytes) << std::flush;
    return file.good();
}

// It takes a moment until the last process is out.
void MemoryGroup::leave() {
    for (int i = 0; i < 100 && !path_.empty(); ++i) {
        if (::rmdir(path_.c_str()) == 0) return path_.clear();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

}  // namespace lightnet::test
