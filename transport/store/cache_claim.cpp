#include "transport/store/cache_claim.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>
#include <utility>

namespace lightnet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view claim_name = "claim-";
constexpr std::size_t digits_of_hash = 64;
constexpr std::size_t most_bytes = 64 << 20;  // of one that is believed

std::string random_name() {
    std::random_device random;
    return std::string(claim_name) + std::to_string(getpid()) + "-" + std::to_string(random());
}

// By the name it was held under: between making it and holding it another may have taken it for that of a dead process.
bool is_there(int file, const std::string& path) {
    struct stat here {};
    struct stat there {};
    return ::fstat(file, &here) == 0 && ::lstat(path.c_str(), &there) == 0 && here.st_ino == there.st_ino &&
           here.st_dev == there.st_dev;
}

void read_claim(int file, std::set<Hash>& blobs) {
    std::string text(digits_of_hash + 1, '\0');
    for (std::size_t at = 0; at < most_bytes; at += text.size()) {
        if (::pread(file, text.data(), text.size(), static_cast<off_t>(at)) != static_cast<ssize_t>(text.size()))
            return;
        if (const auto hash = hash_from_hex(std::string_view(text).substr(0, digits_of_hash))) blobs.insert(*hash);
    }
}

}  // namespace

CacheClaim::CacheClaim(const std::string& folder) {
    constexpr int attempts = 3;
    for (int attempt = 0; attempt < attempts && file_ < 0; ++attempt) {
        path_ = folder + "/" + random_name();
        file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (file_ < 0) return;
        if (::flock(file_, LOCK_SH | LOCK_NB) == 0 && is_there(file_, path_)) return;
        ::close(std::exchange(file_, -1));
    }
}

CacheClaim::~CacheClaim() {
    if (file_ < 0) return;
    ::unlink(path_.c_str());
    ::close(file_);
}

void CacheClaim::add(const std::set<Hash>& blobs) {
    std::string text;
    for (const auto& blob : blobs) text += to_hex(blob) + "\n";
    const char* at = text.data();
    for (auto left = text.size(); file_ >= 0 && left > 0;) {
        const auto written = ::write(file_, at, left);
        if (written <= 0) return;  // the disk is full: what is lost is sent again
        at += written;
        left -= static_cast<std::size_t>(written);
    }
}

std::set<Hash> claimed_in(const std::string& folder) {
    std::set<Hash> blobs;
    std::error_code error;
    for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        std::error_code ignored;
        if (!entry->path().filename().string().starts_with(claim_name) ||
            !fs::is_regular_file(entry->symlink_status(ignored)))
            continue;
        const int file = ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
        if (file < 0) continue;
        if (::flock(file, LOCK_EX | LOCK_NB) == 0)
            fs::remove(entry->path(), ignored);
        else
            read_claim(file, blobs);
        ::close(file);
    }
    return blobs;
}

}  // namespace lightnet
