#include "core/readers/pbrt/pictures.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace lightnet::pbrt {
namespace {

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;  // of up to 16 bytes

}  // namespace

std::shared_ptr<const Image> Pictures::get(const std::string& name, const Encoding& encoding, const SourceLine& where) {
    const Key key{sources_.path(name), encoding.curve, encoding.gamma};
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    const auto bytes = is_one(name, where) ? sources_.read(name, where) : std::nullopt;
    if (!bytes) {
        known_.emplace(key, nullptr);
        return nullptr;
    }
    orders_.push_back(std::make_unique<Order>(Order{name, where, std::make_shared<Image>(), {}}));
    Order& order = *orders_.back();
    known_.emplace(key, order.image);
    workshop_.add([this, &order, bytes = *bytes, encoding] { decode(order, bytes, encoding); });
    return order.image;
}

// False: reported.
bool Pictures::is_one(const std::string& name, const SourceLine& where) const {
    try {
        expect_image(sources_.files.beginning(sources_.path(name), image_beginning));
        return true;
    } catch (const Error& problem) {
        sources_.report.error(where, fmt::format("can't read '{}': {}", name, problem.what()));
        return false;
    }
}

void Pictures::decode(Order& order, const Bytes& bytes, const Encoding& encoding) {
    if (pixels_ > most_pixels) return;
    try {
        Image image = read_image(*bytes, encoding);
        pixels_ += std::uint64_t{image.width} * image.height;
        *order.image = std::move(image);
    } catch (const std::exception& problem) {
        order.problem = problem.what();
    }
}

void Pictures::finish() {
    workshop_.finish();
    for (; reported_ < orders_.size(); ++reported_) {
        const Order& order = *orders_[reported_];
        if (!order.problem.empty())
            sources_.report.error(order.where, fmt::format("'{}': {}", order.name, order.problem));
    }
    if (pixels_ > most_pixels && !std::exchange(too_many_, true))
        sources_.report.error({sources_.main, 0}, "the images of the scene have more than 2^28 pixels in all");
}

}  // namespace lightnet::pbrt
