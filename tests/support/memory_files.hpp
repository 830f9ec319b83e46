// Files that exist only in a test.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/files/files.hpp"

namespace lightnet::test {

inline Bytes bytes_of(const std::string& text) {
    std::vector<std::byte> bytes(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) bytes[i] = static_cast<std::byte>(text[i]);
    return std::make_shared<const std::vector<std::byte>>(std::move(bytes));
}

/// A tree of files by path.
class MemoryFiles final : public Files {
public:
    MemoryFiles() = default;
    /// By path and contents.
    MemoryFiles(std::initializer_list<std::pair<std::string, std::string>> texts) {
        for (const auto& [path, text] : texts) add(path, text);
    }

    void add(const std::string& path, const std::string& text) { files_[path] = bytes_of(text); }

    Bytes read(const std::string& path) override {
        const auto found = files_.find(path);
        if (found == files_.end()) throw Error(path, "no such file");
        return found->second;
    }

    std::optional<std::string> like(const std::string& path) override {
        for (const auto& [known, bytes] : files_)
            if (same_but_for_case(known, path)) return known;
        return std::nullopt;
    }

private:
    std::map<std::string, Bytes> files_;
};

}  // namespace lightnet::test
