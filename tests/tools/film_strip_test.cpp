// Frames of a sequence as files.
#include "tools/pictures/film_strip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/film/exr.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/images/image_file.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/mistake.hpp"

namespace lightnet::film_strip_test {
namespace {

using test::mistake_of;
using testing::HasSubstr;

class FilmStrip : public testing::Test {
protected:
    void frame(int number, float grey, std::uint32_t side = 4) {
        Picture picture;
        picture.width = picture.height = side;
        picture.beauty.assign(std::size_t{side} * side, {grey, grey, grey});
        write_exr(folder.file("shot." + std::to_string(10000 + number).substr(1) + ".exr"), picture);
    }
    std::vector<FrameFile> all() const { return frame_files(folder.file("shot.####.exr")); }
    float grey_of(const std::string& png) const {
        DiskFiles files;
        return read_image(*files.read(folder.file(png))).colour(1, 1).r;
    }

    test::Folder folder;
};

TEST_F(FilmStrip, LeavesWhatIsSomebodyElses) {
    for (const int number : {5, 6}) frame(number, 0);
    const auto view = view_of_film(all(), {});
    const auto mine = folder.write("shot.0005.png", "\x89PNG\r\n\x1a\n of frame 5");
    EXPECT_EQ(mistake_of([&] { write_strip(all(), view, folder.file("shot.####.png")); }), "");
    EXPECT_EQ(std::filesystem::file_size(mine), 19u) << "numbers of the film begin with 1";
    for (const int number : {1, 2}) frame(number, 0);
    EXPECT_THAT(mistake_of([&] { write_strip(all(), view, folder.file("shot.####.png")); }),
                HasSubstr("is the picture beside a frame"));
    folder.write("film.0002.png", "notes");
    EXPECT_THROW(write_strip(all(), view, folder.file("film.####.png")), Error);
    EXPECT_FALSE(std::filesystem::exists(folder / "film.0001.png")) << "all are looked at before one is written";
    EXPECT_THROW(expect_film_place(folder.write("notes.mp4", "notes of a film")), Error);
    EXPECT_NO_THROW(expect_film_place(folder.write("film.mp4", std::string("\0\0\0\x20", 4) + "ftypisom")));
    EXPECT_NO_THROW(expect_film_place(folder / "new.mp4"));
}

TEST_F(FilmStrip, FindsItsFramesInOrderAndWhatIsMissing) {
    for (const int number : {12, 1, 2, 7, 9}) frame(number, 0);
    folder.write("shot.0003.png", "");
    folder.write("shot.001.exr", "");
    folder.write("other.0004.exr", "");
    std::vector<int> numbers;
    for (const auto& file : all()) numbers.push_back(file.number);
    EXPECT_EQ(numbers, (std::vector{1, 2, 7, 9, 12}));
    EXPECT_EQ(missing_frames(all()), "3-6, 8, 10-11");
    EXPECT_THAT(mistake_of([&] { frame_files(folder.file("shot.0001.exr")); }), HasSubstr("they are named like"));
    EXPECT_THAT(mistake_of([&] { frame_files(folder.file("none.####.exr")); }),
                HasSubstr("there is no file of such a name"));
}

TEST_F(FilmStrip, ShowsAllFramesAlikeAndNumbersThemFromOne) {
    frame(5, 0.5f), frame(9, 0.25f);
    const auto view = view_of_film(all(), PictureView::plain);
    write_strip(all(), view, folder.file("strip.##.png"));
    EXPECT_GT(grey_of("strip.01.png"), grey_of("strip.02.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "strip.03.png"));
    frame(11, 0.5f, 8);
    EXPECT_THAT(mistake_of([&] { write_strip(all(), view, folder.file("strip.##.png")); }),
                HasSubstr("has 8x8 pixels, and"));
}

TEST_F(FilmStrip, LaysAllFramesOnOneSheet) {
    frame(1, 0.5f), frame(2, 0.25f), frame(3, 1);
    write_sheet(all(), {}, folder.file("sheet.png"));
    DiskFiles files;
    const auto sheet = read_image(*files.read(folder.file("sheet.png")));
    EXPECT_EQ(sheet.width, 4 + 2 * 8u) << "two columns of 4 pixels, with a margin around each";
    EXPECT_EQ(sheet.height, 4 + 2 * 8u);
    EXPECT_EQ(sheet.colour(0, 0).r, 0);
    EXPECT_NEAR(sheet.colour(5, 5).r, 0.5f, 0.01f);
    EXPECT_NEAR(sheet.colour(13, 5).r, 0.25f, 0.01f);
    EXPECT_NEAR(sheet.colour(5, 13).r, 1, 0.01f);
    EXPECT_EQ(sheet.colour(13, 13).r, 0);
}

}  // namespace
}  // namespace lightnet::film_strip_test
