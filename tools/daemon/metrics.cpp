#include "tools/daemon/metrics.hpp"

#include <fmt/format.h>

#include "core/base/build_info.hpp"
#include "core/base/own_process.hpp"

namespace lightnet {
namespace {

class MetricsWriter {
public:
    void gauge(const std::string& name, const std::string& help, double value, const std::string& labels = "") {
        write(name, "gauge", help, value, labels);
    }
    /// As all programs tell it of themselves.
    void of_process(const std::string& name, const char* type, const std::string& help, double value) {
        text_ +=
            fmt::format("# HELP process_{0} {1}\n# TYPE process_{0} {2}\nprocess_{0} {3}\n", name, help, type, value);
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

void add_process(MetricsWriter& metrics) {
    const auto process = process_figures();
    const auto gauge = [&](const char* name, const char* help, double value) {
        metrics.of_process(name, "gauge", help, value);
    };
    metrics.of_process("cpu_seconds_total", "counter", "Processor time of all threads.", process.processor_seconds);
    gauge("resident_memory_bytes", "Memory that it has now.", double(process.resident));
    gauge("virtual_memory_bytes", "Addresses that it has taken.", double(process.virtually));
    gauge("start_time_seconds", "When it was started, since 1970.", process.started);
    gauge("open_fds", "Files and sockets that it has open.", double(process.descriptors));
    gauge("max_fds", "That it may have open.", double(process.most_descriptors));
    gauge("threads", "Threads that it has.", double(process.threads));
}

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
    metrics.counter("busy_seconds", "Threads at work, up to now.", seconds(busy));
    metrics.counter("waiting_seconds", "Threads that waited for answers, up to now.", seconds(places.waited_ns));
    metrics.counter("idle_seconds", "Threads without work in a run, up to now.", seconds(places.idle_ns));
    for (const auto& [name, count] : Counters::all)
        if (count != &Counters::broken_packets)
            metrics.counter(name,
                            fmt::format("The counter {} of x.run.json, {}.", name,
                                        count == &Counters::rays ? "up to now" : "of runs that have ended"),
                            double(figures.ended.*count));
    metrics.gauge("peak_memory_bytes", "The most memory that it had at once since its last run began.",
                  double(peak_memory()));
    add_process(metrics);
    return metrics.take();
}

std::string why_unfit(const DaemonFigures& figures, std::chrono::steady_clock::time_point now) {
    constexpr auto most_silence = std::chrono::seconds(10);  // figures are renewed several times a second
    if (figures.leaves) return "it was told to stop";
    if (figures.when == std::chrono::steady_clock::time_point{}) return "it does not serve yet";
    if (now - figures.when > most_silence) return "the thread that serves is stuck";
    return {};
}

}  // namespace lightnet
