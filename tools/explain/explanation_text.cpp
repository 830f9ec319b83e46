#include "tools/explain/explanation_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/explain/named_surface.hpp"

namespace lightnet {
namespace {

std::string text_of(Rgb colour) { return fmt::format("{:.5g} {:.5g} {:.5g}", colour.r, colour.g, colour.b); }

// In percent of the luminance; nothing where there is none.
std::string share_of(Rgb part, Rgb whole) {
    const float all = luminance(whole);
    return all > 0 ? fmt::format("{:.1f} %", 100 * luminance(part) / all) : std::string("-");
}

/// One sample, told as an outline: what happened for the answer to a question stands below it, further to the right.
class Story {
public:
    Story(const PixelAccount& pixel, const Account& account, std::string& text)
        : pixel_(pixel), graph_(pixel.network->graph), scene_(*pixel.network->scene), account_(account), text_(text) {}

    void tell() {
        while (question_ < account_.questions.size() || ray_ < account_.rays.size()) tell_next(1);
    }

private:
    // Rays and questions are in one order: a ray knows how many questions came before it.
    bool is_ray_next() const {
        return ray_ < account_.rays.size() && account_.rays[ray_].questions_before <= question_;
    }

    void tell_next(std::size_t level) {
        if (is_ray_next())
            tell_ray(account_.rays[ray_++], level);
        else
            tell_question(question_++, level);
    }

    void line(std::size_t level, const std::string& words) { text_ += std::string(2 * level, ' ') + words + '\n'; }

    std::string name_of(std::size_t within) const {
        const auto& image = graph_.nodes[renderer_of(graph_, pixel_.network->registry)].name;
        return within == AskedQuestion::nobody ? image : graph_.nodes[account_.questions[within].asked].name;
    }

    void tell_ray(const TracedRay& ray, std::size_t level) {
        const auto who = name_of(ray.within);
        if (ray.looks) {
            const bool ends = std::isfinite(ray.ray.far);
            line(level,
                 fmt::format("{} looks {} {}: {}", who, ends ? "to" : "into direction",
                             to_string(ends ? ray.ray.origin + ray.ray.direction * ray.ray.far : ray.ray.direction),
                             ray.hidden ? "hidden" : "free"));
        } else if (ray.hit) {
            line(level, fmt::format("{} sees {}", who, where(*ray.hit)));
        } else {
            line(level, fmt::format("{} sees nothing in direction {}", who, to_string(ray.ray.direction)));
        }
    }

    // What was named last need not be named again.
    std::string where(const Hit& hit) { return unless_named(to_string(named_surface(scene_, hit))); }
    std::string where(const Query& question) { return unless_named(to_string(named_point(scene_, question))); }
    std::string unless_named(const std::string& name) { return std::exchange(last_, name) == name ? "it" : name; }

    void tell_question(std::size_t index, std::size_t level) {
        const auto& asked = account_.questions[index];
        line(level, fmt::format("{} asks {} about {}: {}", graph_.nodes[asked.asker].name,
                                graph_.nodes[asked.asked].name, where(asked.question), answer_of(asked)));
        while (belongs_to(index)) tell_next(level + 1);
    }

    bool belongs_to(std::size_t index) const {
        if (is_ray_next()) return account_.rays[ray_].within == index;
        return question_ < account_.questions.size() && account_.questions[question_].within == index;
    }

    std::string answer_of(const AskedQuestion& asked) const {
        if (asked.answer.size() == 1) return text_of(asked.answer[0]);
        std::string all;
        const auto& layers = pixel_.network->layers.of_node[asked.asked];
        for (std::size_t k = 0; k < asked.answer.size(); ++k)
            all += (k ? ", " : "") +
                   lightnet::name_of(layers[k], pixel_.network->layers, graph_, pixel_.network->registry) + " " +
                   text_of(asked.answer[k]);
        return all;
    }

    const PixelAccount& pixel_;
    const Graph& graph_;
    const Scene& scene_;
    const Account& account_;
    std::string& text_;
    std::string last_;                    // surface
    std::size_t question_ = 0, ray_ = 0;  // next ones
};

std::string of_sample(const PixelAccount& account, const ExplainedSample& part) {
    std::string text = fmt::format("\nsample {}: {}, {} of the pixel", part.sample, text_of(part.beauty),
                                   share_of(part.beauty / float(account.samples), account.pixel.beauty[0]));
    for (std::size_t k = 0; k < account.format.layers.size(); ++k)
        if (!is_black(part.colours[k]))
            text += fmt::format("; {} {}", account.format.layers[k], text_of(part.colours[k]));
    text += '\n';
    Story(account, part.account, text).tell();
    return text;
}

}  // namespace

std::string explanation_text(const PixelAccount& account, const std::string& picture, std::size_t most) {
    const auto& pixel = account.pixel;
    std::string text =
        fmt::format("{}, pixel {},{}: {}\n{} samples were computed again{}\n", picture, account.x, account.y,
                    text_of(pixel.beauty[0]), account.samples,
                    !account.equal   ? ""
                    : *account.equal ? ": all bits of all layers are those of the picture"
                                     : ": THIS IS NOT what the picture has there, as its scene or the program "
                                       "has changed since");
    std::size_t widest = 0;
    for (const auto& layer : pixel.layers) widest = std::max(widest, layer.name.size());
    for (const auto& layer : pixel.layers) {
        const Rgb part = layer.gain * layer.pixels[0];
        text += fmt::format("  {}  {:>8}  {}\n", layer.name + std::string(widest - layer.name.size(), ' '),
                            share_of(part, pixel.beauty[0]), text_of(part));
    }
    for (const auto& layer : pixel.shown)
        text += fmt::format("  {} (shown beside the sum): {}\n", layer.name, text_of(layer.pixels[0]));
    const auto shown = std::min(most, account.parts.size());
    text += fmt::format("{} of {} samples, the brightest first:\n", shown, account.parts.size());
    for (std::size_t i = 0; i < shown; ++i) text += of_sample(account, account.parts[i]);
    return text;
}

}  // namespace lightnet
