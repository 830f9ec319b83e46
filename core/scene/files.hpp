// Where the bytes of a scene come from: a disk, or blobs that were sent.
#pragma once

#include <map>
#include <string>

#include "core/bytes.hpp"

namespace lightnet {

/// A tree of files, by path. Readers of scenes open files only through it, so that a host without the user's disk can
/// read the very same scene. One thread at a time.
class Files {
public:
    virtual ~Files() = default;
    /// The whole file. Throws Error when there is none or it can't be read.
    virtual Bytes read(const std::string& path) = 0;
};

/// The disk. Remembers what was read, so that it can be sent: path → bytes.
class DiskFiles final : public Files {
public:
    Bytes read(const std::string& path) override;
    const std::map<std::string, Bytes>& seen() const { return seen_; }

private:
    std::map<std::string, Bytes> seen_;
};

/// `path` as written inside the file `from`: relative to the folder of `from`, unless absolute. Without "." and "..".
std::string beside(const std::string& from, const std::string& path);

}  // namespace lightnet
