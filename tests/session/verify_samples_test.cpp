// When two captures of a value agree: bit for bit, but for floats that the driver may round to 16 bits.
#include "session/verify_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace shadestep::session {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Values {
 public:
  explicit Values(const std::string& precision)
      : analysis_(frontend::analyse(frontend::Stage::fragment,
                                    {"#version 300 es\nout mediump vec4 o;\nvoid main() {\n  " + precision +
                                     " float a = o.x;\n  o.x = a;\n}\n"},
                                    {})) {
    EXPECT_TRUE(analysis_.shader) << analysis_.error;
    for (std::size_t i = 0; i < analysis_.shader->variables.size(); ++i)
      if (analysis_.shader->variables[i].name == "a") part_.variable = static_cast<frontend::VariableId>(i);
    part_.type.basic = frontend::Basic::float_;
  }
  bool agree(float one, float other) const {
    const auto a = std::bit_cast<std::uint32_t>(one), b = std::bit_cast<std::uint32_t>(other);
    const bool same = session::agree(*analysis_.shader, part_, &a, &b);
    EXPECT_EQ(session::agree(*analysis_.shader, part_, &b, &a), same);
    return same;
  }

 private:
  frontend::Analysis analysis_;
  Part part_;
};

TEST(Agreement, IsThatOfBitsForHighPrecision) {
  const Values values("highp");
  EXPECT_TRUE(values.agree(1, 1));
  EXPECT_TRUE(values.agree(kNan, kNan));
  EXPECT_FALSE(values.agree(1, std::nextafter(1.0F, 2.0F)));
  EXPECT_FALSE(values.agree(kInfinity, 1e6F));
}

TEST(Agreement, AllowsReducedPrecisionItsRounding) {
  const Values values("mediump");
  EXPECT_TRUE(values.agree(0.1F, 0.0999755859375F)) << "rounded to 11 digits";
  EXPECT_FALSE(values.agree(0.1F, 0.101F));
  EXPECT_TRUE(values.agree(0, 0x1p-25F)) << "what is lost below the least of 16 bits";
  EXPECT_FALSE(values.agree(0, 0.001F));
  EXPECT_TRUE(values.agree(kNan, -kNan));
  EXPECT_FALSE(values.agree(kNan, 0));
}

// More than 65504 is infinite in 16 bits; nothing else is.
TEST(Agreement, TakesNothingSmallForAnInfinity) {
  const Values values("mediump");
  EXPECT_TRUE(values.agree(kInfinity, kInfinity));
  EXPECT_TRUE(values.agree(kInfinity, 1e6F));
  EXPECT_TRUE(values.agree(-kInfinity, -65520));
  EXPECT_FALSE(values.agree(kInfinity, 1));
  EXPECT_FALSE(values.agree(kInfinity, -kInfinity));
  EXPECT_FALSE(values.agree(kInfinity, -1e6F));
  EXPECT_FALSE(values.agree(kInfinity, 60000));
}

}  // namespace
}  // namespace shadestep::session
