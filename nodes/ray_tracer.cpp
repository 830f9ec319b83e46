// The renderer: finds what each pixel sees, and asks how bright it is.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/estimate/pixel_filter.hpp"
#include "core/estimate/specular_path.hpp"
#include "core/network/graph/kind.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/scene_media.hpp"

namespace lightnet {
namespace {

/// Follows rays from the eye through mirrors and glass. Where a surface scatters in other ways too it asks its lighting
/// input about those; what shines by itself it adds to the first layers, one for each group of lamps. Samples are
/// spread around the pixel with the density of its filter, so each counts alike, and none crosses the border of a tile.
/// Questions leave in large chunks.
class RayTracer final : public Renderer {
public:
    explicit RayTracer(const NodeContext& here)
        : Renderer(here.inputs().addition()),
          here_(here),
          scene_(here.scene()),
          inputs_(here.inputs()),
          light_(here.inputs().which(false)),
          facts_(here.inputs().which(true)),
          key_(here.key()),
          seed_(here.seed()),
          max_depth_(static_cast<std::uint32_t>(here.integer("max_depth"))),
          alpha_(here.flag("alpha")),
          halves_(here.inputs(), alpha_),
          moves_(scene_.moves() || scene_.camera().moves()),
          background_(here.flag("background")),
          filter_(here.text("filter"), static_cast<float>(here.number("filter_radius"))) {}

    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        const std::size_t at_once = std::max<std::size_t>(1, samples_at_once / std::max(1u, tile.samples));
        for (std::size_t first = 0; first < tile.pixels(); first += at_once)
            render_some(tile, first, std::min(tile.pixels(), first + at_once), pixels);
    }

private:
    // DECISIONS: halves-within-blocks
    /// Of some colours, what the second half of a block's samples adds is kept beside the sum of all: each half is a
    /// well spread set of samples by itself, as an aligned run of a sequence is. Of an odd number, half of the middle
    /// one counts, so that about half of the light is in it whatever the number.
    class Halves {
    public:
        Halves(const Inputs& inputs, bool alpha) : place_of_(inputs.layers(), none) {
            const auto first = static_cast<std::uint32_t>(inputs.layers() - inputs.halved().size() - alpha);
            for (std::uint32_t i = 0; i < inputs.halved().size(); ++i) place_of_[inputs.halved()[i]] = first + i;
        }
        /// How much of that sample of a block of so many is in its second half.
        static float part(std::uint32_t sample, std::uint32_t samples) {
            const std::uint32_t twice = 2 * (sample % samples_per_block) + 1;
            return twice > samples ? 1 : twice == samples ? 0.5f : 0;
        }
        void add(std::span<Rgb> pixel, std::size_t layer, const Rgb& colour, float part) const {
            if (part > 0 && place_of_[layer] != none) pixel[place_of_[layer]] += colour * part;
        }

    private:
        static constexpr std::uint32_t none = ~0u;
        std::vector<std::uint32_t> place_of_;
    };

    /// A path that a sample has still to follow.
    struct Branch {
        SpecularPath path;
        std::optional<Hit> hit;
        std::uint32_t depth;  // mirrors and glass before
    };
    /// Questions about what some pixels see, in order of pixel, sample and depth.
    struct PixelQuestions {
        std::vector<Query> questions;
        std::vector<std::size_t> pixels;  // whose the answers are
        std::vector<Rgb> weights;         // what reaches the eye of them
        std::vector<Branch> branches;     // scratch
        std::vector<Rgb> emitted;         // the same: on one sample's path, by group of lamps
        std::vector<std::size_t> fogged;  // pixels of samples that see a medium, and no surface behind it
    };
    /// One sample of a pixel.
    struct TileSample {
        std::size_t pixel;
        Key key;
        std::uint32_t sample;
    };

    void render_some(const Tile& tile, std::size_t first, std::size_t last, std::span<Rgb> pixels) const {
        std::vector<TileSample> samples;
        const std::vector<Ray> rays = rays_through(tile, first, last, samples);
        std::vector<std::optional<Hit>> hits(rays.size());
        scene_.intersect(rays, hits);

        PixelQuestions met;
        met.questions.reserve(samples.size());
        met.pixels.reserve(samples.size());
        met.weights.reserve(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i)
            follow(samples[i], rays[i], hits[i], met, pixels.subspan(samples[i].pixel * inputs_.layers()), tile);
        if (!met.questions.empty()) add_answers(met, pixels, tile);
        if (!facts_.empty()) add_facts(samples, rays, hits, pixels);
        if (!alpha_) return;
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (hits[i]) pixels[(samples[i].pixel + 1) * inputs_.layers() - 1] += Rgb{1, 1, 1};
        for (const std::size_t pixel : met.fogged) pixels[(pixel + 1) * inputs_.layers() - 1] += Rgb{1, 1, 1};
    }

    /// The rays of the eye through some pixels, sample by sample, which are told.
    std::vector<Ray> rays_through(const Tile& tile, std::size_t first, std::size_t last,
                                  std::vector<TileSample>& samples) const {
        std::vector<Key> keys;
        std::vector<std::uint32_t> indices;
        std::vector<Vec2> corners;
        for (std::size_t pixel = first; pixel < last; ++pixel) {
            const auto x = tile.x + static_cast<std::uint32_t>(pixel % tile.width);
            const auto y = tile.y + static_cast<std::uint32_t>(pixel / tile.width);
            if (!tile.looks_at(x, y)) continue;
            const Key key = pixel_key(seed_, x, y);
            for (std::uint32_t s = 0; s < tile.samples; ++s) {
                samples.push_back({pixel, key, tile.first_sample + s});
                keys.push_back(key);
                indices.push_back(tile.first_sample + s);
                corners.push_back({float(x), float(y)});
            }
        }
        std::vector<Vec2> positions(samples.size()), lens;
        Samples::many_2d(keys, indices, 0, positions);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const Vec2 place = filter_.place(positions[i]);
            positions[i] = {corners[i].x + place.x, corners[i].y + place.y};
        }
        if (scene_.camera().has_lens()) {
            lens.resize(samples.size());
            Samples::many_2d(keys, indices, 1, lens);
        }
        std::vector<Ray> rays(samples.size());
        if (!moves_) {
            scene_.camera().rays(positions, lens, rays);
            return rays;
        }
        std::vector<float> numbers(samples.size());
        Samples::many(keys, indices, 2, numbers);
        std::vector<ShutterTime> times;
        for (const float number : numbers) times.push_back(time_in_shutter(number));
        scene_.camera().rays(positions, lens, times, rays);
        return rays;
    }

    /// Follows one ray until no mirror or glass carries it on, and adds to the pixel what shines by itself on its path.
    /// At glass both branches are followed as long as they carry much: a lamp that is seen in it by chance is noise for
    /// long.
    void follow(const TileSample& sample, const Ray& ray, const std::optional<Hit>& hit, PixelQuestions& met,
                std::span<Rgb> pixel, const Tile& tile) const {
        if (hit && only_scatters(*hit) && !scene_.has_media())
            return ask_about(sample, SpecularPath(ray), *hit, 0, 0, scene_.lobes(*hit), met);
        met.emitted.assign(scene_.lights().groups(), Rgb{});
        met.branches.assign(1, {SpecularPath(ray), hit, 0});
        for (std::uint32_t surface = 0; !met.branches.empty(); ++surface) {
            const Branch branch = met.branches.back();
            met.branches.pop_back();
            visit(sample, branch, surface, met);
        }
        const float part = Halves::part(sample.sample, tile.samples);
        for (std::size_t g = 0; g < met.emitted.size(); ++g) {
            pixel[g] += met.emitted[g];
            halves_.add(pixel, g, met.emitted[g], part);
        }
    }

    /// The surface of that number that a sample meets, and what shines by itself there.
    void visit(const TileSample& sample, Branch branch, std::uint32_t surface, PixelQuestions& met) const {
        if (scene_.has_media() && collides(sample, branch, surface, met)) return;
        if (!branch.hit) {
            if (!background_ && surface == 0) return;
            const Ray& ray = branch.path.ray();
            met.emitted[scene_.lights().environment_group()] += branch.path.weight() * scene_.lights().environment(ray);
            if (const auto sun = scene_.lights().sun(ray.direction))
                met.emitted[sun->group] += branch.path.weight() * sun->light.radiance;
            return;
        }
        branch.path.arrive(branch.hit->distance);
        const auto ask = [&](std::uint8_t lobes) {
            ask_about(sample, branch.path, *branch.hit, branch.depth, surface, lobes, met);
        };
        if (only_scatters(*branch.hit)) return ask(scene_.lobes(*branch.hit));
        const SurfacePoint point = scene_.surface(*branch.hit);
        const Bsdf bsdf = scene_.bsdf(point);
        const Vec3 outgoing = -branch.path.ray().direction;
        const std::uint8_t lobes = bsdf.lobes();
        met.emitted[scene_.lights().group_of(point)] +=
            branch.path.weight() * scene_.lights().emission(point, outgoing);
        if (lobes & lobe::rough) ask(lobes);
        if (!(lobes & lobe::specular) || branch.depth >= max_depth_) return;
        if (const auto reflected = branch.path.split(point, bsdf, both_carry)) {
            met.branches.push_back({*reflected, scene_.intersect(reflected->ray()), branch.depth + 1});
        } else if (!branch.path.go_on(point, bsdf, Samples(child(sample.key, chain_key, surface), sample.sample),
                                      keep)) {
            return;
        }
        met.branches.push_back({branch.path, scene_.intersect(branch.path.ray()), branch.depth + 1});
    }

    /// Does a medium scatter what the sample would meet? Then that is asked about. What media emit belongs to the group
    /// of the environment.
    bool collides(const TileSample& sample, Branch& branch, std::uint32_t surface, PixelQuestions& met) const {
        Ray way = branch.path.ray();
        if (branch.hit) way.far = branch.hit->distance;
        Samples samples(child(sample.key, flight_key, surface), sample.sample);
        const Flight flight = scene_.media().fly(way, branch.path.weight(), samples.next_2d());
        met.emitted[scene_.lights().environment_group()] += branch.path.weight() * flight.emitted;
        branch.path.dim(flight.weight);
        if (!flight.collision) return false;
        branch.path.arrive(flight.collision->distance);
        ask(branch.path.question_about(*flight.collision, branch.depth), sample, branch.path, surface, met);
        if (surface == 0 && !branch.hit) met.fogged.push_back(sample.pixel);
        return true;
    }

    /// Most surfaces do, everywhere alike: who is asked works them out.
    bool only_scatters(const Hit& hit) const {
        const std::uint8_t everywhere = scene_.lobes(hit);
        return everywhere && !(everywhere & lobe::specular) && !scene_.lights().shines(hit.geometry);
    }

    /// The question about rough lobes of that surface, so many mirrors and panes behind the eye.
    void ask_about(const TileSample& sample, const SpecularPath& path, const Hit& hit, std::uint32_t depth,
                   std::uint32_t surface, std::uint8_t lobes, PixelQuestions& met) const {
        ask(path.question_about(hit, lobes, depth), sample, path, surface, met);
    }
    // Written where it stays: one that is put together and then copied would have to lie in memory first.
    [[gnu::always_inline]] void ask(const Query& about, const TileSample& sample, const SpecularPath& path,
                                    std::uint32_t surface, PixelQuestions& met) const {
        Query& question = met.questions.emplace_back(about);
        question.stream = child(sample.key, key_, surface);
        question.sample = sample.sample;
        question.pass = here_.pass_mark(sample.sample);
        met.pixels.push_back(sample.pixel);
        met.weights.push_back(path.weight());
    }

    void add_answers(const PixelQuestions& met, std::span<Rgb> pixels, const Tile& tile) const {
        // The first input makes the image; those that are shown beside it are asked the same.
        for (const Part& part : ask_all(light_, met.questions))
            each_colour(part, [&](std::size_t q, std::size_t layer, const Rgb& colour) {
                const auto pixel = pixels.subspan(met.pixels[q] * inputs_.layers(), inputs_.layers());
                const Rgb seen = colour * met.weights[q];
                pixel[layer] += seen;
                halves_.add(pixel, layer, seen, Halves::part(met.questions[q].sample, tile.samples));
            });
    }

    /// Asks what the samples see first.
    void add_facts(std::span<const TileSample> samples, std::span<const Ray> rays,
                   std::span<const std::optional<Hit>> hits, std::span<Rgb> pixels) const {
        std::vector<Query> questions;
        std::vector<std::size_t> asked;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!hits[i]) continue;
            Query question = SpecularPath(rays[i]).question_about(*hits[i], lobe::all, 0);
            question.stream = child(samples[i].key, key_, 0);
            question.sample = samples[i].sample;
            question.pass = here_.pass_mark(samples[i].sample);
            questions.push_back(question);
            asked.push_back(samples[i].pixel);
        }
        if (questions.empty()) return;
        for (const Part& part : ask_all(facts_, questions))
            each_colour(part, [&](std::size_t q, std::size_t layer, const Rgb& fact) {
                const std::size_t place = asked[q] * inputs_.layers() + layer;
                if (part.input->ids)
                    add_ids(pixels.subspan(place, part.input->ids), {&fact, 1});
                else
                    pixels[place] += fact;
            });
    }

    static constexpr std::size_t samples_at_once = 4096;
    // DECISIONS: both-ways-of-glass
    static constexpr float both_carry = 0.01f;  // at least, where both branches at glass are followed
    static constexpr float keep = 25;           // what is fainter than its inverse is followed seldom
    static constexpr Key chain_key = key_of("chain of mirrors");
    static constexpr Key flight_key = key_of("flights");

    NodeContext here_;
    const Scene& scene_;
    Inputs inputs_, light_, facts_;  // all, and both parts of them
    Key key_;
    std::uint64_t seed_;
    std::uint32_t max_depth_;
    bool alpha_;
    Halves halves_;
    bool moves_;  // anything, while the shutter is open: else no sample needs a time
    bool background_;
    PixelFilter filter_;
};

}  // namespace

Kind ray_tracer_kind() {
    return {
        .name = "RayTracer",
        .role = Role::image,
        .help = "makes the image: follows rays from the eye through mirrors and glass, and asks how bright things are",
        .inputs = {1, 1},
        .params =
            {
                {.name = "scene", .type = ParamType::scene, .help = "what is seen"},
                {.name = "film", .type = ParamType::film, .help = "width, height, and file of the image"},
                {.name = "samples",
                 .type = ParamType::integer,
                 .help = "samples per pixel; with a noise threshold: at most",
                 .unit = "samples",
                 .initial = Value{16.0},
                 .least = 1,
                 .most = 1 << 24},
                {.name = "error",
                 .help = "noise threshold: ends a cell of 8 x 8 pixels before it has all samples, when the mean error "
                         "of its pixels, each relative to the square root of its brightness, is estimated at this, as "
                         "in Cycles: 0.1 (drafts) … 0.001; 0: never",
                 .initial = Value{0.0},
                 .least = 0,
                 .most = 1},
                {.name = "least_samples",
                 .type = ParamType::integer,
                 .help = "with a noise threshold: what every pixel gets, in whole blocks of 16, and at least 32",
                 .unit = "samples",
                 .initial = Value{32.0},
                 .least = 1,
                 .most = 1 << 24},
                {.name = "max_depth",
                 .type = ParamType::integer,
                 .help = "how many mirrors or panes in a row a ray is followed through",
                 .initial = Value{100.0},
                 .least = 0,
                 .most = 255},
                {.name = "show",
                 .type = ParamType::nodes,
                 .help = "operators whose own light is kept beside the image, as layers that are not added up: AOVs",
                 .initial = Value{Table{}}},
                {.name = "layers",
                 .type = ParamType::named_lists,
                 .help =
                     "layers by light path expressions, like caustics = \"C.*DS+L\", instead of one for each of the "
                     "operators that they take",
                 .optional = true},
                {.name = "alpha",
                 .type = ParamType::flag,
                 .help = "adds a channel A: how much of each pixel surfaces cover",
                 .initial = Value{false}},
                {.name = "background",
                 .type = ParamType::flag,
                 .help = "shows what surrounds the scene where nothing is before it; it lights things in any case",
                 .initial = Value{true}},
                {.name = "filter",
                 .type = ParamType::text,
                 .help = "the pixel filter",
                 .initial = Value{"box"},
                 .choices = {"box", "tent", "gaussian"}},
                {.name = "filter_radius",
                 .type = ParamType::number,
                 .help = "how far the filter reaches; 0: as is usual (box 0.5, tent 1, gaussian 1.5)",
                 .unit = "pixels",
                 .initial = Value{0.0},
                 .least = 0,
                 .most = 16},
            },
        .light = {.lamps = true, .groups = true, .paths = always({"LS*E"}), .onward = "S*E"},
        .reads = reading(scene_of_light | ScenePart::camera),
        .asks_by = reading(ScenePart::camera | ScenePart::geometry | ScenePart::materials | ScenePart::media),
        .make_renderer = [](const NodeContext& here) { return std::make_unique<RayTracer>(here); },
    };
}

}  // namespace lightnet
