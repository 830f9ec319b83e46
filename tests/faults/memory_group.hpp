// A group of processes whose memory together is limited, where the system makes such groups for us.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lightnet::test {

/// Where the group of a process would lie, in either version of control groups.
std::vector<std::filesystem::path> memory_groups(int process);

class MemoryGroup {
public:
    MemoryGroup();
    ~MemoryGroup() { leave(); }
    MemoryGroup(const MemoryGroup&) = delete;
    MemoryGroup& operator=(const MemoryGroup&) = delete;

    bool there() const { return !path_.empty(); }
    /// What a shell does to get in, with all that it starts.
    std::string entry() const { return "echo $$ > " + (path_ / "cgroup.procs").string(); }
    /// Bytes that it has.
    double usage() const;
    bool limit(double bytes) const;

private:
    void leave();
    std::filesystem::path path_, limit_, usage_;
};

}  // namespace lightnet::test
