// One run per picture.
#pragma once

#include <string>

#include "core/base/error.hpp"

namespace lightnet {

/// Another run has it.
class PictureTaken final : public UserError {
public:
    using UserError::UserError;
};

/// A lock on a picture, in a file beside it, so that processes of all users and machines that see the folder know of
/// it. It goes with the process, however that ends; a file that is left behind locks nothing.
class PictureLock {
public:
    /// Throws PictureTaken at once when another run has it. Where a disk knows no locks there is none.
    explicit PictureLock(const std::string& picture);
    ~PictureLock();
    PictureLock(const PictureLock&) = delete;
    PictureLock& operator=(const PictureLock&) = delete;

private:
    bool still_there() const;
    std::string path_;
    int file_ = -1;
};

}  // namespace lightnet
