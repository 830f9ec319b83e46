// glTF scenes, written inside a test: accessors are made of the numbers that they hold.
#pragma once

#include <string>
#include <vector>

#include "tests/support/scene_text.hpp"

namespace lightnet::test {

/// A document that grows.
class GltfText {
public:
    /// Adds an accessor; its index.
    template <class Number>
    std::size_t accessor(const std::string& type, int component, const std::vector<Number>& numbers, std::size_t count,
                         const std::string& more = "") {
        std::string bytes;
        for (const Number number : numbers) bytes += raw(number);
        return accessor(type, component, view(bytes), count, more);
    }
    std::size_t vectors(const std::string& type, const std::vector<float>& numbers) {
        const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : std::size_t(type.back() - '0');
        return accessor(type, 5126, numbers, numbers.size() / width);
    }
    /// One without a view: zeros, or what is unpacked.
    std::size_t empty_accessor(const std::string& type, int component, std::size_t count,
                               const std::string& more = "") {
        return add(accessors_, R"({"componentType":)" + std::to_string(component) + R"(,"type":")" + type +
                                   R"(","count":)" + std::to_string(count) + more + "}");
    }
    std::size_t accessor(const std::string& type, int component, std::size_t view, std::size_t count,
                         const std::string& more = "") {
        return empty_accessor(type, component, count, R"(,"bufferView":)" + std::to_string(view) + more);
    }
    /// Adds a view of those bytes; its index. `more`: members of it.
    std::size_t view(const std::string& bytes, const std::string& more = "") {
        const std::size_t at = put(bytes);
        return add(views_, R"({"buffer":0,"byteOffset":)" + std::to_string(at) + R"(,"byteLength":)" +
                               std::to_string(bytes.size()) + more + "}");
    }
    std::size_t view(const std::string& json, std::nullptr_t) { return add(views_, json); }
    /// Where in the buffer they are then.
    std::size_t put(const std::string& bytes) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
        bytes_ += bytes;
        return bytes_.size() - bytes.size();
    }
    /// A .glb of that and `more` members, which end in a comma.
    std::string file(const std::string& more) const {
        const auto list = [](const char* name, const std::vector<std::string>& items) {
            std::string text = std::string("\"") + name + "\":[";
            for (std::size_t i = 0; i < items.size(); ++i) text += (i ? "," : "") + items[i];
            return text + "],";
        };
        return glb(R"({"asset":{"version":"2.0"},)" + more + list("accessors", accessors_) +
                       list("bufferViews", views_) + R"("buffers":[{"byteLength":)" + std::to_string(bytes_.size()) +
                       "}]}",
                   bytes_);
    }
    SceneData read(const std::string& more) const { return read_as("a.glb", file(more)); }
    std::string errors(const std::string& more) const { return errors_as("a.glb", file(more)); }

private:
    static std::size_t add(std::vector<std::string>& to, const std::string& item) {
        to.push_back(item);
        return to.size() - 1;
    }

    std::string bytes_;
    std::vector<std::string> accessors_, views_;
};

/// Of a triangle in the plane z = 0, whose corners are (0,0), (1,0) and (0,1): accessor 0.
inline GltfText triangle_text() {
    GltfText text;
    text.vectors("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    return text;
}

}  // namespace lightnet::test
