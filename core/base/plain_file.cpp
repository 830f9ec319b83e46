#include "core/base/plain_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

std::string in_mebibytes(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

// "": it is one.
std::string why_not_plain(const struct stat& facts) {
    if (S_ISREG(facts.st_mode)) return "";
    if (S_ISDIR(facts.st_mode)) return "is a folder";
    return "is no file, but a pipe or a device";
}

}  // namespace

PlainFile::PlainFile(const std::filesystem::path& path, std::uint64_t most_bytes, Links links)
    : name_(path.string()),
      file_(::open(path.c_str(),
                   O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | (links == Links::refused ? O_NOFOLLOW : 0))) {
    struct stat facts {};
    if (file_ < 0 || ::fstat(file_, &facts) != 0) {
        const int error = errno;
        if (file_ >= 0) ::close(file_);
        throw Error(name_, error == ENOENT ? "no such file" : std::strerror(error));
    }
    size_ = static_cast<std::uint64_t>(facts.st_size);
    std::string why = why_not_plain(facts);
    if (why.empty() && size_ > most_bytes)
        why = "has " + in_mebibytes(size_) + ", more than the " + in_mebibytes(most_bytes) + " that are taken";
    if (why.empty()) return;
    ::close(file_);
    throw Error(name_, why);
}

PlainFile::~PlainFile() { ::close(file_); }

std::size_t PlainFile::read(std::span<std::byte> into) {
    std::size_t done = 0;
    while (done < into.size()) {
        const ssize_t size = ::read(file_, into.data() + done, std::min<std::size_t>(into.size() - done, 1 << 30));
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) throw Error(name_, std::strerror(errno));
        if (size == 0) break;
        done += static_cast<std::size_t>(size);
    }
    return done;
}

void PlainFile::seek(std::uint64_t from_beginning) { ::lseek(file_, static_cast<off_t>(from_beginning), SEEK_SET); }

template <class Content>
Content PlainFile::content() try {
    Content all(size_, {});
    seek(0);
    if (read(std::as_writable_bytes(std::span(all.data(), all.size()))) != size_)
        throw Error(name_, "ends early while being read");
    return all;
} catch (const std::bad_alloc&) {
    throw Error(name_, "has " + in_mebibytes(size_) + ", which is more than there is memory for");
}

std::vector<std::byte> PlainFile::bytes() { return content<std::vector<std::byte>>(); }
std::string PlainFile::text() { return content<std::string>(); }

std::optional<std::string> text_of_plain_file(const std::filesystem::path& path, std::uint64_t most) try {
    return PlainFile(path, most, PlainFile::Links::refused).text();
} catch (const Error&) {
    return std::nullopt;
}

std::optional<Hash> hash_of_plain_file(const std::filesystem::path& path) try {
    PlainFile file(path, std::numeric_limits<std::uint64_t>::max(), PlainFile::Links::refused);
    Hasher hasher;
    std::uint64_t sum = 0;
    std::vector<std::byte> room(std::size_t{1} << 20);
    while (const auto size = file.read(room)) {
        hasher.add(std::span(room).first(size));
        sum += size;
    }
    return sum == file.size() ? std::optional(hasher.finish()) : std::nullopt;
} catch (const Error&) {
    return std::nullopt;
}

}  // namespace lightnet
