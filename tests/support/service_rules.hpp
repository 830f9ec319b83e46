// What a unit of systemd lets its service do, done to this process without systemd.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace lightnet::test {

/// The lines of [Service], by their keys: what stands behind each, one for each line.
class ServiceRules {
public:
    explicit ServiceRules(const std::string& unit_file);
    bool says(const std::string& key, const std::string& value) const;
    /// Of the last line of that key; "": there is none.
    std::string value(const std::string& key) const;
    const std::vector<std::string>& environment() const { return environment_; }

    /// Applies to this process and its children, for good: files that can't be written, no rights, no new ones, and
    /// filters of system calls. What isn't named here (devices, limits of control groups) is left as it is. `writable`:
    /// folders that stay so. Throws std::runtime_error where the system doesn't let us.
    void apply(const std::vector<std::string>& writable) const;

private:
    void protect_files(const std::vector<std::string>& writable) const;
    void filter_calls() const;
    std::map<std::string, std::string> lines_;
    std::vector<std::string> environment_;
};

}  // namespace lightnet::test
