// EXR files of several parts.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/film/exr.hpp"
#include "tests/film/pictures.hpp"

namespace lightnet::exr_parts_test {
namespace {

TEST(Exr, HoldsTheSameInPartsOfTheirOwn) {
    const Folder folder;
    Picture picture = for_compositing();
    picture.samples = std::vector<float>(15, 3);
    picture.shown.push_back({"rgba", noise(15, 9)});
    picture.x = 2, picture.y = 1, picture.whole_width = 20, picture.whole_height = 10;
    for (const auto& compression : lossless_compressions())
        for (const bool half : {false, true}) {
            picture.storage = {compression, half, true};
            if (half)
                for (auto& layer : picture.shown) round_to_half(layer.pixels);
            write_exr(folder / "x.exr", picture);
            EXPECT_TRUE(read_exr(folder / "x.exr") == picture) << compression;
        }
    Imf::MultiPartInputFile file((folder / "x.exr").c_str());
    std::vector<std::string> names;
    for (int part = 0; part < file.parts(); ++part) names.push_back(file.header(part).name());
    EXPECT_THAT(names, testing::ElementsAre("rgba", picture.layers[0].name, picture.layers[1].name,
                                            picture.layers[2].name, "depth", "rgba_", "CryptoObject"));
    EXPECT_TRUE(file.header(1).channels().findChannel(picture.layers[0].name + ".R"));
    EXPECT_EQ(exr_of(picture), exr_of(picture));
}

// Of a file of other programs whose parts have other windows, those of the first count.
TEST(Exr, LeavesPartsOfOtherPixelsAlone) {
    const Folder folder;
    std::vector<Imf::Header> headers;
    for (const int width : {4, 8}) {
        Imf::Header header(8, 2);
        header.dataWindow() = {{0, 0}, {width - 1, 1}};
        header.setName("part" + std::to_string(width));
        header.setType(Imf::SCANLINEIMAGE);
        for (const char* channel : {"R", "G", "B", "A"})
            if (width == 8 || *channel != 'A') header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        headers.push_back(header);
    }
    const std::vector<float> values(16, 0.5f);
    {
        Imf::MultiPartOutputFile file((folder / "x.exr").c_str(), headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            Imf::FrameBuffer buffer;
            const auto& window = headers[std::size_t(part)].dataWindow();
            for (const char* channel : {"R", "G", "B", "A"})
                buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(values.data()), window));
            Imf::OutputPart into(file, part);
            into.setFrameBuffer(buffer);
            into.writePixels(2);
        }
    }
    const Picture picture = read_exr(folder / "x.exr");
    EXPECT_EQ(picture.width, 4u);
    EXPECT_EQ(picture.beauty[7], (Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_TRUE(picture.alpha.empty());
}

}  // namespace
}  // namespace lightnet::exr_parts_test
