#include "tools/watch/live_cleaning.hpp"

#include <memory>
#include <new>
#include <utility>

#include "core/base/spare_threads.hpp"

namespace lightnet {
namespace {

constexpr std::chrono::seconds period{2};
constexpr double others = 9;  // times as long as it took, nothing is cleaned

}  // namespace

LiveCleaning::LiveCleaning(const FilmFormat& format)
    : colours_(format.halves() ? format.layers.size() : 0), pace_(period, Clock::now()) {}

LiveCleaning::Cleaned LiveCleaning::cleaned(Picture noisy, CleanQuality quality) {
    const auto begun = Clock::now();
    try {
        auto picture = clean(std::move(noisy), quality).picture;
        return {std::move(picture), Clock::now() - begun};
    } catch (const std::bad_alloc&) {
        return {{}, Clock::now() - begun};
    }
}

bool LiveCleaning::look(const Film& film) {
    if (colours_ == 0) return false;
    const auto now = Clock::now();
    const bool whole = film.covered() == 1;
    bool others_now = false;
    if (!whole) {
        outdated_ = at_work_.valid();
        others_now = cleaned_.has_value();
        cleaned_.reset();
    }
    if (at_work_.valid()) {
        if (at_work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return others_now;
        auto made = at_work_.get();
        if (!std::exchange(outdated_, false)) {
            pace_.put_off(now, others * made.took);
            if (made.picture) cleaned_ = std::move(made.picture), others_now = true;
        }
    }
    if (whole && (!cleaned_ || pace_.due(now))) begin(film);
    return others_now;
}

void LiveCleaning::begin(const Film& film) {
    const auto noisy = std::make_shared<Picture>(film.picture(film.scale()));
    at_work_ = in_background([noisy] { return cleaned(std::move(*noisy), CleanQuality::draft); });
}

bool LiveCleaning::finish(const Film& film) {
    if (colours_ == 0 || film.covered() < 1) return false;
    at_work_ = {};
    if (auto made = cleaned(film.picture(film.scale()), CleanQuality::usual); made.picture)
        cleaned_ = std::move(made.picture);
    return cleaned_.has_value();
}

std::vector<Rgb> LiveCleaning::so_far(const Film& film, const Tile& area) const {
    const auto views = film.so_far(area);
    if (colours_ == 0) return views;
    const std::size_t each = views.size() / area.pixels();
    std::vector<Rgb> all;
    all.reserve(views.size() + area.pixels() * colours_);
    for (std::size_t i = 0; i < area.pixels(); ++i) {
        const auto own = views.begin() + std::ptrdiff_t(i * each);
        all.insert(all.end(), own, own + std::ptrdiff_t(each));
        // A crop has no more than its own pixels, where cells of the film may have others.
        const std::size_t x = area.x + i % area.width, y = area.y + i / area.width;
        const bool there = cleaned_ && x >= cleaned_->x && x - cleaned_->x < cleaned_->width && y >= cleaned_->y &&
                           y - cleaned_->y < cleaned_->height;
        for (std::size_t k = 0; k < colours_; ++k)
            all.push_back(there ? cleaned_->layers[k].pixels[(y - cleaned_->y) * cleaned_->width + x - cleaned_->x]
                                : own[std::ptrdiff_t(k)]);
    }
    return all;
}

}  // namespace lightnet
