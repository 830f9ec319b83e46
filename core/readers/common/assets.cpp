#include "core/readers/common/assets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/readers/images/image_facts.hpp"

namespace lightnet {
namespace {

KnownImage made_sound(Image decoded) {
    auto [image, remark] = sound(std::move(decoded));
    return {std::make_shared<const Image>(std::move(image)), std::move(remark)};
}

bool has_light(const SceneData& scene) {
    return !scene.environments.empty() || !scene.lights.empty() ||
           std::ranges::any_of(scene.shapes, [](const Shape& shape) { return shape.emission.has_value(); });
}

}  // namespace

Assets::Found Assets::try_read(const std::string& path) {
    try {
        return {files_.read(path), ""};
    } catch (const MissingHere&) {
        throw;
    } catch (const Error& problem) {
        return {nullptr, problem.what()};
    }
}

std::optional<Bytes> Assets::read(const std::string& path, const SourceLine& where) {
    auto [bytes, problem] = try_read(path);
    if (bytes) return std::move(bytes);
    if (path != where.file)  // the scene's own name is not guessed at
        for (const std::string& place : other_places(where.file, path)) {
            report_.warn(where, fmt::format("'{}': {}: '{}' is taken", path, problem, place));
            return files_.read(place);
        }
    report_.error(where, fmt::format("can't read a file: {}", problem));
    return std::nullopt;
}

bool Assets::exists(const std::string& path) { return try_read(path).bytes != nullptr; }

const Assets::Picture& Assets::decoded(const std::string& name, const Encoding& encoding,
                                       const std::function<KnownImage()>& decode) {
    const auto [entry, fresh] = pictures_.try_emplace({name, encoding.curve, encoding.gamma});
    if (!fresh) return entry->second;
    try {
        const KnownImage made = decode();
        entry->second = {made.image, "", made.remark};
    } catch (const MissingHere&) {
        throw;
    } catch (const Error& problem) {
        entry->second.problem = problem.what();
    }
    return entry->second;
}

const Assets::Picture& Assets::try_picture(const std::string& path, const Encoding& encoding) {
    return decoded(path, encoding, [&] {
        expect_image(files_.beginning(path, image_beginning));
        const Bytes file = files_.read(path);
        if (auto known = known_image(file, encoding)) return *std::move(known);
        const KnownImage made = made_sound(read_image(*file, encoding));
        remember_image(file, encoding, made);
        return made;
    });
}

// DECISIONS: grey-stands-in
std::shared_ptr<const Image> Assets::or_grey(const std::string& name, const Picture& picture, const SourceLine& where) {
    if (!picture.remark.empty()) report_.warn(where, fmt::format("image '{}': {}", name, picture.remark));
    if (picture.image) return picture.image;
    report_.warn(where, fmt::format("image '{}': {}: mid-grey is taken instead", name, picture.problem));
    if (!grey_) grey_ = std::make_shared<const Image>(mid_grey());
    return grey_;
}

std::shared_ptr<const Image> Assets::picture(const std::string& path, const Encoding& encoding,
                                             const SourceLine& where) {
    const Picture& first = try_picture(path, encoding);
    if (!first.image && !exists(path))
        for (const std::string& place : other_places(where.file, path))
            if (const Picture& other = try_picture(place, encoding); other.image) {
                report_.warn(where, fmt::format("image '{}': {}: '{}' is taken", path, first.problem, place));
                return or_grey(place, other, where);
            }
    return or_grey(path, first, where);
}

std::shared_ptr<const Image> Assets::picture(const std::string& name, std::span<const std::byte> bytes,
                                             const Encoding& encoding, const SourceLine& where) {
    return or_grey(name, decoded(name, encoding, [&] { return made_sound(read_image(bytes, encoding)); }), where);
}

std::shared_ptr<const Image> Assets::no_picture(const std::string& name, const std::string& why,
                                                const SourceLine& where) {
    return or_grey(name, {nullptr, why}, where);
}

std::vector<NamedImage> Assets::pictures(const SourceLine& where) const {
    std::vector<NamedImage> all;
    for (const auto& [key, picture] : pictures_) all.push_back({picture.image.get(), std::get<0>(key), where});
    return all;
}

TextureId Assets::add(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

TextureId Assets::colour(Rgb value) {
    const auto [entry, fresh] = colours_.try_emplace({value.r, value.g, value.b});
    if (fresh) {
        Texture constant;
        constant.scale = value;
        entry->second = add(std::move(constant));
    }
    return entry->second;
}

MaterialId Assets::add(Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<MaterialId>(scene_.materials.size() - 1);
}

Rgb mean_colour(const SceneData& scene, TextureId id) {
    const Texture& texture = scene.textures[id];
    Rgb mean{1, 1, 1};
    if (const auto* pattern = std::get_if<ImageTexture>(&texture.pattern); pattern && pattern->image) {
        double r = 0, g = 0, b = 0;
        const auto& image = *pattern->image;
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const Rgb pixel = image.colour(x, y);
                r += double(pixel.r), g += double(pixel.g), b += double(pixel.b);
            }
        const double count = std::max(1.0, double(image.width) * image.height);
        mean = {float(r / count), float(g / count), float(b / count)};
    } else if (const auto* squares = std::get_if<CheckerTexture>(&texture.pattern)) {
        mean = (mean_colour(scene, squares->even) + mean_colour(scene, squares->odd)) * 0.5f;
    }
    mean *= texture.scale;
    return texture.invert ? Rgb{1, 1, 1} - mean : mean;
}

SceneData read_by_assets(Files& files, const std::string& path, const std::function<void(Assets&)>& fill) {
    Report report;
    SceneData scene;
    Assets assets(files, report, scene);
    fill(assets);
    report.check();
    warn_below_black(scene, assets.pictures({path, 0}), report);
    if (!has_light(scene)) {
        report.warn({path, 0},
                    "there is no light: a constant environment of radiance 1 is taken " + std::string(choose_around));
        scene.environments.emplace_back();
    }
    scene.warnings = report.warnings();
    return scene;
}

}  // namespace lightnet
