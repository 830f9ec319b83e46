// A folder for what nobody wants to keep.
#pragma once

#include <filesystem>
#include <string>

namespace lightnet {

/// A new folder of this user's alone, in $TMPDIR or else in /tmp. Gone with this object, with all that is in it.
class TemporaryFolder {
public:
    /// `name`: how it begins, behind "lightnet-". Throws Error when none can be made.
    explicit TemporaryFolder(const std::string& name);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

}  // namespace lightnet
