#include "core/readers/files/files.hpp"

#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/plain_file.hpp"
#include "core/base/thread_pool.hpp"

namespace lightnet {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{8} << 30;

// In pieces, between which somebody may have lost interest.
Hash hash_of(std::span<const std::byte> bytes, const std::atomic<bool>& ended) {
    constexpr std::size_t piece = std::size_t{16} << 20;
    Hasher hasher;
    for (; !bytes.empty() && !ended; bytes = bytes.subspan(std::min(piece, bytes.size())))
        hasher.add(bytes.first(std::min(piece, bytes.size())));
    return hasher.finish();
}

}  // namespace

std::vector<std::byte> Files::beginning(const std::string& path, std::size_t most) {
    const auto all = read(path);
    return {all->begin(), all->begin() + std::ptrdiff_t(std::min(most, all->size()))};
}

DiskFiles::DiskFiles() : thread_pool_(std::make_unique<ThreadPool>(2)) {}
DiskFiles::~DiskFiles() { ended_ = true; }

std::vector<std::byte> DiskFiles::beginning(const std::string& path, std::size_t most) {
    std::vector<std::byte> bytes(most);
    bytes.resize(PlainFile(path, largest_file).read(bytes));
    return bytes;
}

Bytes DiskFiles::read(const std::string& path) {
    if (const auto known = seen_.find(path); known != seen_.end()) return known->second;
    auto bytes = std::make_shared<const std::vector<std::byte>>(PlainFile(path, largest_file).bytes());
    seen_.emplace(path, bytes);
    thread_pool_->add([this, bytes, &hash = hashes_[path]] { hash = hash_of(*bytes, ended_); });
    return bytes;
}

// From folder to folder, each of which may be named in several ways.
std::optional<std::string> DiskFiles::like(const std::string& path) {
    namespace fs = std::filesystem;
    std::vector<fs::path> found{{}};
    const fs::path whole(path);
    for (const fs::path& part : whole) {
        std::vector<fs::path> next;
        for (const fs::path& folder : found) {
            if (part == whole.root_path() || part == ".." || part == ".") {
                next.push_back(folder / part);
                continue;
            }
            std::error_code problem;
            const fs::directory_iterator end;
            for (fs::directory_iterator at(folder.empty() ? "." : folder, problem); !problem && at != end;
                 at.increment(problem))
                if (same_but_for_case(at->path().filename().string(), part.string()))
                    next.push_back(folder / at->path().filename());
        }
        found = std::move(next);
    }
    std::error_code problem;
    std::erase_if(found, [&](const fs::path& one) { return !fs::is_regular_file(one, problem); });
    const auto first = std::ranges::min_element(found);
    return first == found.end() ? std::nullopt : std::optional(first->string());
}

std::string DiskFiles::real_path(const std::string& path) const {
    std::error_code problem;
    const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(path), problem);
    return problem ? path : real.string();
}

std::map<std::string, Hash> DiskFiles::hashes() {
    thread_pool_->finish();
    return hashes_;
}

bool same_but_for_case(std::string_view a, std::string_view b) {
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
    return std::ranges::equal(a, b, {}, small, small);
}

std::string beside(const std::string& from, const std::string& path) {
    std::string name = path;
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::filesystem::path written(name);
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
