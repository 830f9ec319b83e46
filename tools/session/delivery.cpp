#include "tools/session/delivery.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <thread>

#include "core/base/error.hpp"
#include "core/base/words_of.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/summary.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto pause = std::chrono::milliseconds(500);  // between two attempts

// "": it was written. Else why not.
std::string attempt(const Delivery& delivery, const std::string& picture) {
    try {
        delivery.write(picture);
        return "";
    } catch (const std::bad_alloc&) {
        return picture + ": there is not enough memory to encode it";
    } catch (const std::exception& error) {
        return words_of(error);
    }
}

std::string attempt_for_long(const Delivery& delivery, const std::string& picture) {
    auto why = attempt(delivery, picture);
    if (why.empty()) return why;
    delivery.say("the picture can't be written: " + why + "; trying again for " +
                 std::to_string(delivery.patience.count()) + " s");
    for (const auto end = Clock::now() + delivery.patience; Clock::now() < end && !delivery.hurried();) {
        std::this_thread::sleep_for(pause);
        why = attempt(delivery, picture);
        if (why.empty()) return why;
    }
    return why;
}

// The last words of a run that is done. `asked`: hosts that were to take part; `exposure`: stops.
void conclude(RunRecorder& book, const Hosts& asked, double exposure) {
    const FilmFormat& format = book.steps().film().format();
    auto layers = format.layers;
    layers.insert(layers.end(), format.shown.begin(), format.shown.end());
    if (format.alpha) layers.emplace_back("A");
    RunAccount& account = book.account();
    if (const auto& error = account.report().error)
        account.say(fmt::format("relMSE to {}: {:g}", error->reference, error->relative_square));
    const ShownInPng& png = book.files().png();
    account.say(summary_of({account.report(), layers, asked, png.brightness, exposure, png.request.stops, png.stops}));
}

}  // namespace

std::string new_folder_in(const std::string& folder) {
    std::string name = folder + "/lightnet-XXXXXX";  // mkdtemp makes a name of it that is new
    return ::mkdtemp(name.data()) ? name : "";
}

std::vector<std::string> folders_of_last_resort() {
    const char* const temporary = std::getenv("TMPDIR");
    std::vector<std::string> folders{temporary && *temporary ? temporary : "/tmp"};
    const char* const home = std::getenv("HOME");
    const passwd* const user = ::getpwuid(::getuid());
    if (home && *home)
        folders.emplace_back(home);
    else if (user)
        folders.emplace_back(user->pw_dir);
    return folders;
}

std::string deliver(const Delivery& delivery, const std::string& picture) {
    const auto why = attempt_for_long(delivery, picture);
    if (why.empty()) return picture;
    for (const auto& folder : delivery.elsewhere) {
        const auto own = new_folder_in(folder);
        if (own.empty()) continue;
        const auto there = own + "/" + fs::path(picture).filename().string();
        if (attempt(delivery, there).empty()) {
            delivery.say("the picture can't be written: " + why + "; it is in " + there);
            return there;
        }
        std::error_code ignored;
        fs::remove_all(own, ignored);
    }
    throw Error("the picture can't be written, nor anywhere else: " + why);
}

int finish_run(RunRecorder& book, const RunRequest& request, double exposure, const std::atomic<bool>& hurried) {
    Delivery delivery;
    delivery.write = [&](const std::string& picture) { book.write_picture(picture); };
    delivery.patience = request.wait;
    delivery.hurried = [&] { return hurried.load(); };
    delivery.say = [&](const std::string& text) { book.account().alert(text); };
    delivery.elsewhere = folders_of_last_resort();
    const auto picture = deliver(delivery, request.output);
    const bool in_place = picture == request.output;
    if (in_place) book.end_checkpoint(!request.forget);
    book.write_report(picture, in_place ? "done" : "failed", request.trace);
    if (!request.frame) conclude(book, request.hosts, exposure);  // else the sequence has the last word
    return in_place ? exit_code::done : exit_code::failed;
}

}  // namespace lightnet
