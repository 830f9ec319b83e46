#include "core/readers/pbrt/pictures.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "core/base/words_of.hpp"
#include "core/readers/common/below_black.hpp"
#include "core/readers/files/other_places.hpp"
#include "core/readers/images/image_facts.hpp"
#include "core/readers/images/known_images.hpp"

namespace lightnet::pbrt {
namespace {

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;  // of up to 16 bytes

}  // namespace

std::shared_ptr<const Image> Pictures::get(const std::string& name, const Encoding& encoding, const SourceLine& where) {
    const Key key{sources_.path(name), encoding.curve, encoding.gamma};
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    orders_.push_back(std::make_unique<Order>(Order{name, where, std::make_shared<Image>()}));
    Order& order = *orders_.back();
    const Bytes bytes = read(order);
    std::shared_ptr<const Image> image = order.image;
    if (const auto made = bytes ? known_image(bytes, encoding) : std::nullopt) {
        order.known = image = made->image;
        order.remark = made->remark;
        pixels_ += std::uint64_t{image->width} * image->height;
    } else if (bytes) {
        thread_pool_.add([this, &order, bytes, encoding] { decode(order, bytes, encoding); });
    }
    known_.emplace(key, image);
    return image;
}

// Null: its problem says why.
Bytes Pictures::read(Order& order) const {
    try {
        return expected(sources_.path(order.name));
    } catch (const MissingHere&) {
        throw;
    } catch (const Error& problem) {
        order.problem = problem.what();
    }
    for (const auto& place : other_places(sources_.files, order.where.file, sources_.path(order.name))) try {
            const Bytes bytes = expected(place);
            sources_.report.warn(order.where,
                                 fmt::format("image '{}': {}: '{}' is taken", order.name, order.problem, place));
            order.problem.clear();
            return bytes;
        } catch (const MissingHere&) {
            throw;
        } catch (const Error&) {  // nor is that an image
        }
    return nullptr;
}

Bytes Pictures::expected(const std::string& path) const {
    expect_image(sources_.files.beginning(path, image_beginning));
    return sources_.files.read(path);
}

void Pictures::decode(Order& order, const Bytes& bytes, const Encoding& encoding) {
    if (pixels_ > most_pixels) return;
    try {
        auto [image, remark] = sound(read_image(*bytes, encoding));
        pixels_ += std::uint64_t{image.width} * image.height;
        *order.image = std::move(image);
        order.remark = std::move(remark);
        remember_image(bytes, encoding, {order.image, order.remark});
    } catch (const MissingHere& problem) {
        order.problem = problem.what(), order.here_only = true;
    } catch (const std::exception& problem) {
        order.problem = words_of(problem);
    }
}

void Pictures::finish() {
    thread_pool_.finish();
    for (; reported_ < orders_.size(); ++reported_) {
        const Order& order = *orders_[reported_];
        if (!order.remark.empty())
            sources_.report.warn(order.where, fmt::format("image '{}': {}", order.name, order.remark));
        if (order.problem.empty()) continue;
        if (order.here_only) throw MissingHere(order.name, order.problem);
        sources_.report.warn(order.where,
                             fmt::format("image '{}': {}: mid-grey is taken instead", order.name, order.problem));
        *order.image = mid_grey();
    }
    if (pixels_ > most_pixels && !std::exchange(too_many_, true))
        sources_.report.error({sources_.main, 0}, "the images of the scene have more than 2^28 pixels in all");
}

void Pictures::warn_below_black(const SceneData& scene) const {
    std::vector<NamedImage> all;
    for (const auto& order : orders_)
        all.push_back({order->known ? order->known.get() : order->image.get(), order->name, order->where});
    lightnet::warn_below_black(scene, all, sources_.report);
}

}  // namespace lightnet::pbrt
