// Files, images (each decoded once) and textures, on which readers draw while they fill a scene.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/readers/common/below_black.hpp"
#include "core/readers/common/report.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/files/other_places.hpp"
#include "core/readers/images/image_file.hpp"
#include "core/readers/images/known_images.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Of one read of one scene; what it is made from must outlive it. One thread.
class Assets {
public:
    Assets(Files& files, Report& report, SceneData& scene) : files_(files), report_(report), scene_(scene) {}

    /// The bytes of the file at `path`. None: reported.
    std::optional<Bytes> read(const std::string& path, const SourceLine& where);
    /// Bytes of a file, or null and why there are none.
    struct Found {
        Bytes bytes;
        std::string problem;
    };
    Found try_read(const std::string& path);
    bool exists(const std::string& path);
    /// See lightnet::stays_beside().
    bool stays_beside(const std::string& from, const std::string& path) const {
        return lightnet::stays_beside(files_, from, path);
    }
    /// See lightnet::other_places().
    std::vector<std::string> other_places(const std::string& from, const std::string& written) {
        return lightnet::other_places(files_, from, written);
    }
    /// An image, or why there is none.
    struct Picture {
        std::shared_ptr<const Image> image;
        std::string problem;
        std::string remark{};  // what is strange about the image; "": nothing
    };
    const Picture& try_picture(const std::string& path, const Encoding& encoding);
    /// The image at `path`, or at another place where the file that names it may mean one; one that is missing or
    /// damaged is mid-grey. But for the first, a warning says so.
    std::shared_ptr<const Image> picture(const std::string& path, const Encoding& encoding, const SourceLine& where);
    /// An image inside another file; `name` tells it from all others.
    std::shared_ptr<const Image> picture(const std::string& name, std::span<const std::byte> bytes,
                                         const Encoding& encoding, const SourceLine& where);
    /// Mid-grey for one of that name that can't be had, with a warning.
    std::shared_ptr<const Image> no_picture(const std::string& name, const std::string& why, const SourceLine& where);

    TextureId add(Texture texture);
    TextureId colour(Rgb value);
    TextureId grey(float value) { return colour({value, value, value}); }
    MaterialId add(Material material);

    /// The images that were read, for what is said of them in the end.
    std::vector<NamedImage> pictures(const SourceLine& where) const;

    Report& report() const { return report_; }
    SceneData& scene() const { return scene_; }

private:
    using Key = std::tuple<std::string, Encoding::Curve, float>;

    const Picture& decoded(const std::string& name, const Encoding& encoding,
                           const std::function<KnownImage()>& decode);
    std::shared_ptr<const Image> or_grey(const std::string& name, const Picture& picture, const SourceLine& where);

    Files& files_;
    Report& report_;
    SceneData& scene_;
    std::map<Key, Picture> pictures_;
    std::shared_ptr<const Image> grey_;  // null: not needed so far
    std::map<std::tuple<float, float, float>, TextureId> colours_;
};

/// Mean colour of a texture's pattern times its scale, where that is easy to say; else its scale.
Rgb mean_colour(const SceneData& scene, TextureId texture);

/// The scene in the file at `path` by what `fill` adds to it. Throws UserError with all that is reported. Scenes
/// without light get a constant environment of radiance 1, and a warning that names `--env`.
SceneData read_by_assets(Files& files, const std::string& path, const std::function<void(Assets&)>& fill);

}  // namespace lightnet
