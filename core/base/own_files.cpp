#include "core/base/own_files.hpp"

#include <algorithm>
#include <cctype>
#include <span>
#include <string>
#include <system_error>

#include "core/base/error.hpp"
#include "core/base/plain_file.hpp"

namespace lightnet {

namespace fs = std::filesystem;

bool has_ending(const fs::path& path, std::string_view ending) {
    const auto theirs = path.extension().string();
    return std::equal(theirs.begin(), theirs.end(), ending.begin(), ending.end(), [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    });
}

fs::path png_beside(const fs::path& picture) { return fs::path(picture).replace_extension(".png"); }

std::string why_not_replaced(const fs::path& path, std::string_view beginning, std::size_t before) {
    std::error_code error;
    const auto status = fs::status(path, error);  // of what a link leads to
    if (!fs::exists(status)) return "";
    if (fs::is_directory(status)) return "is a folder";
    if (!fs::is_regular_file(status)) return "is no file, but a pipe or a device";
    if (fs::file_size(path, error) == 0 && !error) return "";
    std::string text(before + beginning.size(), '\0');
    try {
        PlainFile in(path, ~std::uint64_t{0});
        text.resize(in.read(std::as_writable_bytes(std::span(text))));
    } catch (const Error&) {
        return "is there already, and can't be read: it may be somebody else's";
    }
    if (text.size() >= before && text.substr(before) == beginning) return "";
    return "is there already, and is nothing that lightnet has written: it is left alone (move it, or choose another "
           "name)";
}

void expect_ours(const fs::path& path, std::string_view beginning, std::size_t before) {
    if (const auto why = why_not_replaced(path, beginning, before); !why.empty()) throw Error(path.string(), why);
}

}  // namespace lightnet
