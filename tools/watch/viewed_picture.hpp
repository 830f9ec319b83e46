// A finished picture, as the page shows it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/film/picture.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"
#include "tools/preview/watch_board.hpp"
#include "tools/watch/watch_json.hpp"

namespace lightnet {

/// A picture and the file that it comes from.
struct PictureFile {
    std::string name;
    Picture picture;
};

/// What a film would have had that made it: layers, what is beside them, mattes, alpha, gains, crop. A picture without
/// layers has one, its beauty.
FilmFormat format_of(const Picture& picture);

/// A picture on a WatchBoard, with its cleaned layers where it has what that needs, and another one of the same size
/// behind it. One thread's.
class ViewedPicture {
public:
    /// Throws UserError where the other picture has another size or window, or where both are too large to be shown.
    ViewedPicture(PictureFile shown, std::optional<PictureFile> other);

    const FilmFormat& format() const { return format_; }
    /// For the page. `graph` is that of the picture; without nodes: it isn't known.
    std::string hello(const Graph& graph, const Registry& registry) const;
    const std::shared_ptr<WatchBoard>& board() const { return board_; }
    /// Puts all pixels on the board.
    void show();
    /// Cleans the picture, which takes a while, and shows it anew. Does nothing where that can't be done.
    void clean();

    static constexpr std::size_t most_bytes = std::size_t{2} << 30;  // of the board; the page takes as much

private:
    using Source = const std::vector<Rgb>*;  // null: black
    std::vector<Source> sources() const;
    Viewed viewed() const;

    PictureFile shown_;
    std::optional<PictureFile> other_;
    std::optional<Picture> cleaned_;
    FilmFormat format_;
    std::vector<std::vector<Rgb>> mattes_;  // as colours; and alpha behind them, as grey
    std::shared_ptr<WatchBoard> board_;
};

}  // namespace lightnet
