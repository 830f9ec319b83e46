// A process that may use a part of the machine's processors and no more, where the system can see to that: so that one
// machine plays several of different speed.
#pragma once

#include <filesystem>
#include <string>

namespace lightnet::bench {

class ProcessorGroup {
public:
    /// Processes in it may use so many processors together, 0.25 for instance.
    ProcessorGroup(const std::string& name, double processors);
    ~ProcessorGroup();
    ProcessorGroup(const ProcessorGroup&) = delete;
    ProcessorGroup& operator=(const ProcessorGroup&) = delete;

    /// False: this system limits nobody for us.
    bool there() const { return !path_.empty(); }
    /// From now on, with all that it starts.
    void take(int process) const;

private:
    std::filesystem::path path_;
};

}  // namespace lightnet::bench
