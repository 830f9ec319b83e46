#include "tools/explain/pixel_account.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/error.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/assembly/load_scene.hpp"
#include "core/run/serial/serial.hpp"
#include "tools/pictures/picture_notes.hpp"
#include "tools/request/run_settings.hpp"
#include "transport/store/cache_folder.hpp"
#include "transport/store/result_cache.hpp"

namespace lightnet {
namespace {

[[noreturn]] void not_explained(const std::string& what) { throw UserError(SourceLine{"the picture", 0}, what); }

std::size_t index_in(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    if (x < picture.x || y < picture.y || x - picture.x >= picture.width || y - picture.y >= picture.height)
        not_explained(fmt::format("has no pixel {},{}: its pixels go from {},{} to {},{}", x, y, picture.x, picture.y,
                                  picture.x + picture.width - 1, picture.y + picture.height - 1));
    return std::size_t{y - picture.y} * picture.width + (x - picture.x);
}

std::uint32_t samples_at(const Picture& picture, std::size_t index, const FilmFormat& format) {
    if (!picture.samples.empty()) return static_cast<std::uint32_t>(picture.samples[index]);
    if (picture.done < 1)
        not_explained("is a preview, and doesn't tell how many samples its pixels have; let its run finish first");
    // A run may have ended before it had all that its graph wants.
    const auto noted = noted_samples(picture);
    return noted ? std::clamp(*noted, 1u, format.samples) : format.samples;
}

void expect_same_shape(const Picture& picture, const FilmFormat& format) {
    std::vector<std::string> names;
    for (const auto& layer : picture.layers) names.push_back(layer.name);
    const bool whole = !picture.whole_width;
    const auto width = whole ? picture.width : picture.whole_width,
               height = whole ? picture.height : picture.whole_height;
    if (names != format.layers || width != format.width || height != format.height)
        not_explained("is not the one that this report tells of: size or layers differ (--report names another)");
}

// A film for one pixel that adds up as that of the whole picture does.
FilmFormat of_one_pixel(FilmFormat format, std::uint32_t x, std::uint32_t y, std::uint32_t samples) {
    format.crop = Window{x, y, 1, 1};
    format.samples = samples;
    // Where cells decide, how many samples there are was decided by all pixels of the cell.
    if (format.adaptive()) format.refinement = {std::numeric_limits<float>::min(), samples};
    return format;
}

// What a film takes of a pixel: itself, or its cell, of which nobody will look at the rest.
void add_block(Film& film, Tile tile, std::span<const Rgb> colours) {
    if (!film.format().adaptive()) {
        film.add(tile, colours);
        return;
    }
    Tile cell = tile;
    cell.x -= tile.x % cell_size, cell.y -= tile.y % cell_size;
    cell.width = std::min(cell_size, film.format().width - cell.x);
    cell.height = std::min(cell_size, film.format().height - cell.y);
    std::vector<Rgb> all(cell.pixels() * colours.size());
    const std::size_t pixel = std::size_t{tile.y - cell.y} * cell.width + (tile.x - cell.x);
    std::copy(colours.begin(), colours.end(), all.begin() + static_cast<std::ptrdiff_t>(pixel * colours.size()));
    film.add(cell, all);
}

bool same_bits(const std::vector<PictureLayer>& one, const std::vector<PictureLayer>& picture, std::size_t index) {
    for (std::size_t k = 0; k < one.size(); ++k)
        if (std::memcmp(&one[k].pixels[0], &picture[k].pixels[index], sizeof(Rgb)) != 0) return false;
    return one.size() == picture.size();
}

// The files of mattes come in another order than that of the graph.
bool same_ids(const Picture& one, const Picture& picture, std::size_t index) {
    if (one.alpha.empty() != picture.alpha.empty() || one.mattes.size() != picture.mattes.size()) return false;
    if (!one.alpha.empty() && one.alpha[0] != picture.alpha[index]) return false;
    for (const auto& matte : one.mattes) {
        const auto found = std::find_if(picture.mattes.begin(), picture.mattes.end(),
                                        [&](const auto& other) { return other.name == matte.name; });
        if (found == picture.mattes.end() || found->ranks != matte.ranks) return false;
        const auto first = found->pixels.begin() + std::ptrdiff_t(index * matte.ranks);
        if (!std::equal(matte.pixels.begin(), matte.pixels.end(), first)) return false;
    }
    return true;
}

// What runs have prepared already need not be prepared again.
std::unique_ptr<DiskResultCache> cache_of(const Network& network) {
    if (preparing_nodes(network.graph, network.registry).empty()) return nullptr;
    try {
        return std::make_unique<DiskResultCache>(default_cache_folder(), Tuning{}.cache_size);
    } catch (const Error&) {
        return nullptr;  // which is slower, and no error
    }
}

// Those that are no numbers come first: they are what one is looking for.
float rank_of(const ExplainedSample& part) {
    return finite(part.beauty) ? luminance(part.beauty) : std::numeric_limits<float>::infinity();
}

/// One pixel of it, sample by sample.
class OnePixel {
public:
    OnePixel(PixelAccount& account, float scale, AccountKeeper& keeper, SerialRun& run)
        : account_(account),
          scale_(scale),
          film_(of_one_pixel(account.format, account.x, account.y, account.samples)),
          keeper_(keeper),
          run_(run) {
        film_.expose(scale);
    }

    void count() {
        for (std::uint32_t block = 0; block < blocks_in(account_.samples); ++block) {
            const Tile whole{
                account_.x, account_.y, 1, 1, block * samples_per_block, samples_of(block, account_.samples)};
            add_block(film_, whole, run_.render(whole));
            for (std::uint32_t s = 0; s < whole.samples; ++s) count_sample(whole, whole.first_sample + s);
        }
        account_.pixel = film_.picture(scale_);
        std::stable_sort(account_.parts.begin(), account_.parts.end(),
                         [](const auto& a, const auto& b) { return rank_of(a) > rank_of(b); });
    }

private:
    void count_sample(Tile tile, std::uint32_t sample) {
        tile.first_sample = sample, tile.samples = 1;
        auto& part = account_.parts.emplace_back();
        part.sample = sample;
        keeper_.begin();
        part.colours = run_.render(tile);
        part.account = keeper_.end();
        const auto& format = account_.format;
        for (std::size_t k = 0; k < part.colours.size(); ++k) {
            if (format.is_light(k)) part.colours[k] = part.colours[k] * scale_;
            const Rgb gain = k < format.gains.size() ? format.gains[k] : Rgb{1, 1, 1};
            if (k < format.layers.size()) part.beauty += gain * part.colours[k];
        }
    }

    PixelAccount& account_;
    float scale_;
    Film film_;
    AccountKeeper& keeper_;
    SerialRun& run_;
};

}  // namespace

struct PixelRecount::Parts {
    Source source;
    std::unique_ptr<ResultCache> cache;
    AccountKeeper keeper;
    SerialRun run;  // asks through the keeper's tap

    Parts(Source given, std::unique_ptr<ResultCache> results, std::function<void()> pause)
        : source(std::move(given)), cache(std::move(results)), run(*source.network, std::move(pause), &keeper) {
        run.prepare(source.made_from, cache.get());
    }
};

PixelRecount::PixelRecount(Source source, std::unique_ptr<ResultCache> cache, std::function<void()> pause)
    : parts_(std::make_unique<Parts>(std::move(source), std::move(cache), std::move(pause))) {}
PixelRecount::~PixelRecount() = default;

PixelAccount PixelRecount::account(std::uint32_t x, std::uint32_t y, std::uint32_t samples) {
    PixelAccount account;
    account.network = parts_->source.network;
    account.format = parts_->source.format;
    account.x = x, account.y = y, account.samples = samples;
    OnePixel(account, parts_->source.scale, parts_->keeper, parts_->run).count();
    return account;
}

PixelAccount account_for(const Picture& picture, const PastRun& past, std::uint32_t x, std::uint32_t y,
                         const Registry& registry) {
    RunRequest request;
    request.graph = past.graph;
    request.scene = scene_file(past.graph, registry);
    request.seed = past.seed;
    const FilmFormat format = film_format(request, registry);
    expect_same_shape(picture, format);
    const auto index = index_in(picture, x, y);
    const auto samples = samples_at(picture, index, format);

    DiskFiles files;
    LoadedScene scene = load_scene(past.graph, registry, files, request.scene);
    const float scale = scene.data.film.scale;
    const Job job = make_job(request, registry, format, files);
    const auto made = made_from_if_prepared(job, registry, scene);
    const auto network = build_network(job, registry, std::move(scene));
    PixelRecount recount({network, format, made, scale}, cache_of(*network));
    PixelAccount account = recount.account(x, y, samples);
    account.equal = same_bits(account.pixel.layers, picture.layers, index) &&
                    same_bits(account.pixel.shown, picture.shown, index) && same_ids(account.pixel, picture, index);
    return account;
}

}  // namespace lightnet
