// Decoded images that are found again by the bytes of their files.
#include "core/readers/images/known_images.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace lightnet::known_images_test {
namespace {

Bytes file_of(char what) { return std::make_shared<const std::vector<std::byte>>(1000, std::byte(what)); }
std::shared_ptr<const Image> some_image() { return std::make_shared<const Image>(mid_grey()); }

TEST(KnownImages, AreFoundByBytesAndEncoding) {
    const auto image = some_image(), other = some_image();
    remember_image(file_of('a'), {}, {image, "odd"});
    remember_image(file_of('b'), {}, {other});
    const auto found = known_image(file_of('a'), {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->image, image);
    EXPECT_EQ(found->remark, "odd");
    EXPECT_EQ(known_image(file_of('b'), {})->image, other);
    EXPECT_FALSE(known_image(file_of('c'), {}));
    EXPECT_FALSE(known_image(file_of('a'), {Encoding::Curve::linear}));
}

TEST(KnownImages, AreKnownAsLongAsSomebodyHasThem) {
    auto image = some_image();
    remember_image(file_of('d'), {}, {image});
    image.reset();
    EXPECT_FALSE(known_image(file_of('d'), {}));
}

TEST(KnownImages, KeepNoBytesOfTheirFiles) {
    const auto image = some_image();
    auto file = file_of('e');
    remember_image(file, {}, {image});
    const std::weak_ptr bytes = file;
    file.reset();
    EXPECT_TRUE(bytes.expired());
    EXPECT_TRUE(known_image(file_of('e'), {}));
}

}  // namespace
}  // namespace lightnet::known_images_test
