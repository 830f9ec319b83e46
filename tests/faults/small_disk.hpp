// A disk that is as small and as full as a test wants.
#pragma once

#include <filesystem>
#include <string>

namespace lightnet::test {

/// Lies at `at`, where only this process and those that it starts see it: it goes with them.
class SmallDisk {
public:
    /// What forbids such disks here; empty: nothing.
    static std::string obstacle();

    SmallDisk(std::filesystem::path at, std::size_t kilobytes);
    ~SmallDisk();
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    /// Fills it until no more than so much is left.
    void leave(std::size_t kilobytes) const;
    /// Takes away again what fills it.
    void clear() const;
    /// Nothing can be written to it any more.
    void protect() const;
    const std::filesystem::path& path() const { return at_; }

private:
    std::filesystem::path at_;
};

}  // namespace lightnet::test
