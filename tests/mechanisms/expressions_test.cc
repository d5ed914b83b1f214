// Formulas in files: their values, their units, their derivatives, and what is wrong with them.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "vmech/base/dual.h"
#include "vmech/mechanisms/expressions/expression.h"
#include "vmech/mechanisms/expressions/quantity.h"
#include "vmech/mechanisms/expressions/unit.h"

namespace vmech::expressions_test {
namespace {

constexpr double kPi = std::numbers::pi;

const Unit kMillimetre = *FindUnit("mm");
const Unit kDegree = *FindUnit("deg");
const Unit kNone;
const CountingUnits kFile{kMillimetre, kDegree, *FindUnit("kg"), *FindUnit("s"), {}};

const NamedQuantities<double> kNames{{"crank", {50, kMillimetre, false, false}},
                                     {"turn", {30, kDegree, false, false}},
                                     {"n", {6, {}, true, false}}};

double In(const std::string& text, const Unit& asked) {
  return FigureIn(Expression(text).Evaluate(kNames, kFile), asked);
}

std::string ErrorOf(const std::string& text, const Unit& asked = kMillimetre) {
  try {
    In(text, asked);
  } catch (const ExpressionError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Expressions, HaveTheValuesOfTheirArithmetic) {
  EXPECT_EQ(In("1 + 2*3 - 8/4", kNone), 5);
  EXPECT_EQ(In("-2^2", kNone), -4);
  EXPECT_EQ(In("2^3^2", kNone), 512);
  EXPECT_EQ(In("2^-1", kNone), 0.5);
  EXPECT_EQ(In("10 - 4 - 3", kNone), 3);
  EXPECT_EQ(In("8/4/2", kNone), 1);
  EXPECT_EQ(In("(1 + 2)*-(3)", kNone), -9);
  EXPECT_EQ(In("1.5e2 + .5", kNone), 150.5);
  EXPECT_EQ(In("min(3, max(1, 2)) + abs(-4) + sqrt(16)", kNone), 10);
}

TEST(Expressions, ConvertUnitsExactlyWhereTheyAreTheSame) {
  EXPECT_EQ(In("50 mm", kMillimetre), 50);
  EXPECT_EQ(In("3*crank", kMillimetre), 150);
  EXPECT_EQ(In("0.1 mm", kMillimetre), 0.1);
  EXPECT_EQ(In("6 cm", kMillimetre), 60);
  EXPECT_EQ(In("crank + 5", kMillimetre), 55);  // 5 counts in the unit of the file
  EXPECT_EQ(In("5 + 1 cm", kMillimetre), 15);
  EXPECT_EQ(In("7", kMillimetre), 7);
  EXPECT_EQ(In("sqrt(crank^2)", kMillimetre), 50);
  EXPECT_EQ(In("10 N mm / 2 N", kMillimetre), 5);
  EXPECT_DOUBLE_EQ(In("9.81 m/s^2 * 2 kg", *ParseUnit("N")), 19.62);
  EXPECT_EQ(In("crank/25 mm", kNone), 2);
}

TEST(Expressions, TakeAnglesWithTheirUnitOrNotAtAll) {
  EXPECT_DOUBLE_EQ(In("sin(turn)", kNone), 0.5);
  EXPECT_DOUBLE_EQ(In("cos(60 deg)", kNone), 0.5);
  EXPECT_DOUBLE_EQ(In("tan(pi/4)", kNone), 1);
  EXPECT_DOUBLE_EQ(In("asin(0.5)", kDegree), 30);
  EXPECT_DOUBLE_EQ(In("acos(0.5)", kDegree), 60);
  EXPECT_DOUBLE_EQ(In("atan2(crank, -crank)", kDegree), 135);
  EXPECT_DOUBLE_EQ(In("pi/2", kDegree), 90);
  EXPECT_DOUBLE_EQ(In("turn/rad", kNone), kPi / 6);
  EXPECT_EQ(In("360/n", kDegree), 60);
  EXPECT_NE(ErrorOf("sin(30)", kNone).find("sin(30 deg)"), std::string::npos);
  EXPECT_NE(ErrorOf("180/pi*atan2(1, 2)", kDegree).find("no conversion"), std::string::npos);
}

TEST(Expressions, ThatMixDimensionsAreTold) {
  EXPECT_EQ(ErrorOf("crank*crank"), "an area, where a length is asked");
  EXPECT_EQ(ErrorOf("2 kg"), "a mass, where a length is asked");
  EXPECT_EQ(ErrorOf("crank/crank"), "a number, where a length is asked");
  EXPECT_EQ(ErrorOf("crank + turn"), "the sum of a length and an angle");
  EXPECT_EQ(ErrorOf("max(crank, 1 kg)"), "max of a length and a mass");
  EXPECT_EQ(ErrorOf("1/2 mm"), "a 1/length, where a length is asked");
  EXPECT_EQ(ErrorOf("sin(crank)"), "sin of a length; it takes an angle");
  EXPECT_EQ(ErrorOf("2^crank"), "an exponent is a number, not a length");
}

TEST(Expressions, WithoutAValueAreTold) {
  EXPECT_EQ(ErrorOf("1/(n - 6)"), "division by zero");
  EXPECT_EQ(ErrorOf("0^-1"), "division by zero: a power below zero of 0");
  EXPECT_EQ(ErrorOf("sqrt(-4)"), "root of -4, which is below zero");
  EXPECT_EQ(ErrorOf("acos(1.5)"), "acos of 1.5, which is not from -1 to 1");
  EXPECT_EQ(ErrorOf("1e300*1e300"), "not finite");
  EXPECT_EQ(ErrorOf("atan2(0, 0)"), "atan2 of 0 and 0, which is no direction");
  EXPECT_NE(ErrorOf("(-8)^(1/3)").find("is no number"), std::string::npos);
}

TEST(Expressions, ThatAreMistypedSayWhatIsMissing) {
  EXPECT_NE(ErrorOf("40deg").find("a blank is missing before 'deg'"), std::string::npos);
  EXPECT_NE(ErrorOf("2 crank").find("an operator is missing before 'crank'"), std::string::npos);
  EXPECT_EQ(ErrorOf("(1 + 2"), "a ')' is missing");
  EXPECT_EQ(ErrorOf("1 + 2)"), "a ')' without its '('");
  EXPECT_EQ(ErrorOf("2**3"), "'**' is written '^'");
  EXPECT_EQ(ErrorOf("max(1)"), "max takes two numbers, not 1");
  EXPECT_EQ(ErrorOf("sqrt"), "sqrt is a function: sqrt(..)");
  EXPECT_NE(ErrorOf("sinus(3)").find("there is no function 'sinus'"), std::string::npos);
  EXPECT_EQ(ErrorOf("1 +"), "it ends where a number or a name is wanted");
  EXPECT_EQ(ErrorOf("1, 2"), "a ',' outside of the parentheses of a function");
  EXPECT_EQ(ErrorOf("007"), "a number with a leading zero");
  EXPECT_NE(ErrorOf(std::string(60, '(')).find("nested too deeply"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(60, '-')).find("too many signs"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(1001, '1')).find("longer than 1000"), std::string::npos);
}

TEST(Expressions, KnowWhatCannotBeAName) {
  EXPECT_EQ(NameDefect("crank_2"), "");
  EXPECT_NE(NameDefect("m").find("m is a unit"), std::string::npos);
  EXPECT_NE(NameDefect("min").find("min is a unit"), std::string::npos);
  EXPECT_NE(NameDefect("sin").find("a meaning"), std::string::npos);
  EXPECT_NE(NameDefect("pi").find("a meaning"), std::string::npos);
  for (const char* name : {"", "2a", "a-b", "a.b", "\xC3\xA9"}) EXPECT_NE(NameDefect(name), "");
}

/// Every operation at x = 1.3, its slope against a difference of fourth order in the values.
TEST(Expressions, CarryExactDerivatives) {
  const auto at = [](const std::string& text, double x) {
    const NamedQuantities<double> names{{"x", {x, {}, true, false}}};
    return FigureIn(Expression(text).Evaluate(names, CountingUnits()), kNone);
  };
  for (const std::string text :
       {"3*x - x/2 + 7", "1/x^2", "x^x", "2^x", "sqrt(x)", "sin(x)*cos(x)", "tan(x)",
        "asin(x/2)/rad", "acos(x/2)/rad", "atan2(x, 2)/rad", "atan2(3, x)/rad", "abs(-x)",
        "min(x, 5) + max(x, 1)", "-(x + 1)*(x - 2)", "(x^2 + 1)/(x - 4)"}) {
    const NamedQuantities<Dual> names{{"x", {Dual(1.3, 1), {}, true, false}}};
    const Dual value = FigureIn(Expression(text).Evaluate(names, CountingUnits()), kNone);
    const double h = 5e-4;
    const double slope = (8 * (at(text, 1.3 + h) - at(text, 1.3 - h)) -
                          (at(text, 1.3 + 2 * h) - at(text, 1.3 - 2 * h))) /
                         (12 * h);
    EXPECT_NEAR(value.value, at(text, 1.3), 1e-15 * std::abs(value.value)) << text;
    EXPECT_NEAR(value.slope, slope, 1e-9 * std::max(1.0, std::abs(slope))) << text;
  }
}

}  // namespace
}  // namespace vmech::expressions_test
