// JSON as glTF uses it: values that know where in the file they stand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "core/base/json.hpp"
#include "core/readers/common/report.hpp"

namespace lightnet::gltf {

/// What a document may hold: scenes are large.
inline constexpr JsonLimits document_limits{std::numeric_limits<std::size_t>::max(), 20'000'000, 64};

/// Values that somebody asked for: members of objects, and objects in lists.
using Seen = std::unordered_set<const Json*>;

/// A place in a document, there or not. What has the wrong type is reported with its path ("nodes[3].mesh"), and the
/// fallback taken. The document and the report must outlive it.
class At {
public:
    /// `seen`: learns what is asked for; null: nobody wants to know.
    At(const Json& root, std::string file, Report& report, Seen* seen = nullptr)
        : json_(&root), file_(std::move(file)), report_(&report), seen_(seen) {}

    explicit operator bool() const { return json_ != nullptr; }
    At operator[](std::string_view member) const;
    At operator[](std::size_t item) const;
    /// Of a list; 0: it is none.
    std::size_t size() const;
    /// The names of an object's members.
    std::vector<std::string> names() const;

    double number(double fallback) const;
    float real(float fallback) const { return static_cast<float>(number(double(fallback))); }
    bool boolean(bool fallback) const;
    std::string text(const std::string& fallback) const;
    /// A whole number from 0 on.
    std::optional<std::uint64_t> whole() const;
    std::uint64_t whole(std::uint64_t fallback) const { return whole().value_or(fallback); }
    /// An index into a list of that many. None: not there, or reported.
    std::optional<std::size_t> index(std::size_t count) const;
    template <std::size_t count>
    std::array<double, count> numbers(const std::array<double, count>& fallback) const {
        std::array<double, count> result = fallback;
        read(result.data(), count);
        return result;
    }

    void error(const std::string& what) const;
    void warn(const std::string& what) const { report_->warn({file_, 0}, what); }
    const std::string& path() const { return path_; }
    const std::string& file() const { return file_; }
    Report& report() const { return *report_; }

private:
    template <class T>
    const T* as(const char* name) const;
    std::optional<double> any_number() const;
    void read(double* into, std::size_t count) const;

    const Json* json_ = nullptr;
    std::string path_, file_;
    Report* report_ = nullptr;
    Seen* seen_ = nullptr;
};

}  // namespace lightnet::gltf
