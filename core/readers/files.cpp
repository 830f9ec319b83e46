#include "core/readers/files.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/workshop.hpp"

namespace lightnet {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{8} << 30;

std::vector<std::byte> room_for(std::uintmax_t size, const std::string& path) try {
    return std::vector<std::byte>(size);
} catch (const std::bad_alloc&) {
    throw Error(path, "has " + std::to_string(size >> 20) + " MiB, which is more than there is memory for");
}

std::vector<std::byte> read_disk(const std::string& path) {
    std::error_code problem;
    const auto status = std::filesystem::status(path, problem);
    if (!std::filesystem::exists(status)) throw Error(path, "no such file");
    // a pipe or a device could make the reader wait for ever
    if (!std::filesystem::is_regular_file(status)) throw Error(path, "not a file");
    const auto size = std::filesystem::file_size(path, problem);
    if (problem) throw Error(path, problem.message());
    if (size > largest_file) throw Error(path, "larger than 8 GiB");

    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw Error(path, std::strerror(errno));
    auto bytes = room_for(size, path);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size) throw Error(path, "ends early while being read");
    return bytes;
}

}  // namespace

DiskFiles::DiskFiles() : workshop_(std::make_unique<Workshop>(2)) {}
DiskFiles::~DiskFiles() = default;

Bytes DiskFiles::read(const std::string& path) {
    if (const auto known = seen_.find(path); known != seen_.end()) return known->second;
    auto bytes = std::make_shared<const std::vector<std::byte>>(read_disk(path));
    seen_.emplace(path, bytes);
    workshop_->add([bytes, &hash = hashes_[path]] { hash = content_hash(*bytes); });
    return bytes;
}

std::string DiskFiles::real_path(const std::string& path) const {
    std::error_code problem;
    const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(path), problem);
    return problem ? path : real.string();
}

std::map<std::string, Hash> DiskFiles::hashes() {
    workshop_->finish();
    return hashes_;
}

std::string beside(const std::string& from, const std::string& path) {
    const std::filesystem::path written(path);
    if (written.is_absolute()) return written.lexically_normal().string();
    return (std::filesystem::path(from).parent_path() / written).lexically_normal().string();
}

bool lies_within(const std::string& folder, const std::string& path) {
    const auto within = std::filesystem::path(folder.empty() ? "." : folder).lexically_normal();
    const auto way = std::filesystem::path(path).lexically_normal().lexically_relative(within);
    return !way.empty() && *way.begin() != "..";
}

// DECISIONS: gltf-stays-in-its-folder
bool stays_beside(const Files& files, const std::string& from, const std::string& path) {
    const std::filesystem::path parent = std::filesystem::path(from).parent_path();
    const std::string folder = parent.empty() ? "." : parent.string();
    return lies_within(folder, path) && lies_within(files.real_path(folder), files.real_path(path));
}

std::string stem_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

}  // namespace lightnet
