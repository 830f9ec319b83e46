// Scenes of any format, written inside a test.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "core/readers/read_scene.hpp"
#include "tests/support/pbrt_text.hpp"

namespace lightnet::test {

/// The scene of that text, in a file of that name, whose ending tells the format.
inline SceneData read_as(const std::string& name, const std::string& text, MemoryFiles files = {}) {
    files.add(name, text);
    return read_scene(files, name);
}

inline std::string errors_as(const std::string& name, const std::string& text, MemoryFiles files = {}) {
    try {
        read_as(name, text, std::move(files));
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

/// Elements of a Mitsuba scene, in line 1.
inline SceneData read_mitsuba(const std::string& elements, MemoryFiles files = {}) {
    return read_as("scene.xml", "<scene version=\"3.0.0\">" + elements + "</scene>", std::move(files));
}
inline std::string errors_of_mitsuba(const std::string& elements, MemoryFiles files = {}) {
    return errors_as("scene.xml", "<scene version=\"3.0.0\">" + elements + "</scene>", std::move(files));
}

/// A rectangle with that bsdf.
inline SceneData read_mitsuba_bsdf(const std::string& bsdf, MemoryFiles files = {}) {
    return read_mitsuba("<shape type=\"rectangle\">" + bsdf + "</shape>", std::move(files));
}

/// A value's bytes.
template <class Value>
std::string raw(Value value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}
template <class Value, class... More>
std::string raw(Value value, More... more) {
    return raw(value) + raw(more...);
}

/// A .glb of that JSON and those bytes.
inline std::string glb(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto total = static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size());
    return "glTF" + raw(std::uint32_t{2}, total, static_cast<std::uint32_t>(json.size()), std::uint32_t{0x4E4F534A}) +
           json + raw(static_cast<std::uint32_t>(binary.size()), std::uint32_t{0x004E4942}) + binary;
}

}  // namespace lightnet::test
