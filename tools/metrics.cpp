#include "tools/metrics.hpp"

#include <fmt/format.h>

#include "core/base/build_info.hpp"

namespace lightnet {
namespace {

class MetricsWriter {
public:
    void gauge(const std::string& name, const std::string& help, double value, const std::string& labels = "") {
        write(name, "gauge", help, value, labels);
    }
    void counter(const std::string& name, const std::string& help, double value) {
        write(name + "_total", "counter", help, value, "");
    }
    std::string take() { return std::move(text_); }

private:
    void write(const std::string& name, const char* type, const std::string& help, double value,
               const std::string& labels) {
        text_ += fmt::format("# HELP lightnet_{0} {1}\n# TYPE lightnet_{0} {2}\nlightnet_{0}{3} {4}\n", name, help,
                             type, labels, value);
    }
    std::string text_;
};

}  // namespace

std::string metrics_of(const DaemonFigures& figures) {
    MetricsWriter metrics;
    metrics.gauge("build_info", "The build that serves; always 1.", 1, "{version=\"" + build_id() + "\"}");
    metrics.gauge("places", "Threads that render.", figures.places);
    metrics.gauge("serving", "1 while a run is served.", figures.serves);
    metrics.gauge("leaving", "1 since the daemon was told to stop.", figures.leaves);
    metrics.counter("runs", "Runs that the daemon began to serve.", double(figures.runs));
    metrics.counter("answered", "Bundles and tiles answered, up to now.", double(figures.answered));
    metrics.counter("broken_packets", "Packets that were dropped.", double(figures.broken_packets));
    PlaceRecord places;
    if (!figures.ended.places.empty()) places = figures.ended.places.front();
    const auto busy = places.lived_ns - places.waited_ns - places.idle_ns;
    const auto seconds = [](std::uint64_t ns) { return double(ns) * 1e-9; };
    metrics.counter("busy_seconds", "Threads at work, in runs that have ended.", seconds(busy));
    metrics.counter("waiting_seconds", "Threads that waited for answers, in runs that have ended.",
                    seconds(places.waited_ns));
    metrics.counter("idle_seconds", "Threads without work, in runs that have ended.", seconds(places.idle_ns));
    for (const auto& [name, count] : Counters::all)
        if (count != &Counters::broken_packets)
            metrics.counter(name, fmt::format("The counter {} of x.run.json, of runs that have ended.", name),
                            double(figures.ended.*count));
    return metrics.take();
}

}  // namespace lightnet
