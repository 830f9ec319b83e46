// Scenes that have a reference picture, and where their files lie.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/folder.hpp"

namespace lightnet::bench {

/// A scene and its reference, a linear picture of the same size.
struct ReferenceScene {
    std::string name;
    std::string main, reference;  // files, as reference_file() finds them
    std::string rest;             // the folder below the one beside the project that holds what `main` names; empty: it
                                  // lies beside `main`
    double noise = 0;             // of the reference: mean of d² / (reference² + 0.01)
    double target = 1e-3;         // in the same measure
    int samples = 16;             // per pixel, that take some seconds
    double share = 0.55;          // of bare Embree's rate: the goal
};

/// All of them.
const std::vector<ReferenceScene>& reference_scenes();

/// Where the files of a scene are while this lives.
class SceneFiles {
public:
    explicit SceneFiles(const ReferenceScene& scene);

    /// None: all are here.
    const std::optional<std::string>& missing() const { return missing_; }
    const std::filesystem::path& main() const { return main_; }
    const std::filesystem::path& reference() const { return reference_; }

private:
    std::optional<std::string> missing_;
    std::optional<test::Folder> together_;
    std::filesystem::path main_, reference_;
};

}  // namespace lightnet::bench
