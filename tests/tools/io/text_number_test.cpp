#include "tools/io/text_number.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

Real read_whole(const std::string& text) {
  Real out;
  INFO(text);
  REQUIRE(read_real(text.data(), text.data() + text.size(), out) == text.data() + text.size());
  return out;
}

std::string print(const char* format, double value) {
  std::string out(400, '\0');
  out.resize(static_cast<size_t>(std::snprintf(out.data(), out.size(), format, value)));
  return out;
}

float random_float(std::mt19937& random, int least_exponent, int most_exponent) {
  std::uniform_real_distribution<float> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(least_exponent, most_exponent);
  return std::ldexp(mantissa(random), exponent(random));
}

}  // namespace

TEST_CASE("numbers are the nearest binary32 values, as the C library gives them") {
  std::mt19937 random(1);
  const char* const formats[] = {"%.3f", "%.6f",  "%.8f", "%.15f", "%g",
                                 "%.8g", "%.17g", "%.6e", "%.30e"};
  for (int i = 0; i < 20000; ++i) {
    const double value = std::ldexp(std::uniform_real_distribution<>(-1, 1)(random),
                                    static_cast<int>(random() % 40) - 15);
    const std::string text = print(formats[random() % std::size(formats)], value);
    INFO(text);
    CHECK(std::bit_cast<uint32_t>(read_whole(text).value) ==
          std::bit_cast<uint32_t>(std::strtof(text.c_str(), nullptr)));
  }
}

TEST_CASE("numbers beyond binary32 and its least ones") {
  for (const char* text : {"3.4028235e38",
                           "3.4028236e38",
                           "1e39",
                           "-1e400",
                           "1.4e-45",
                           "7e-46",
                           "7.1e-46",
                           "-1e-60",
                           "1e-400",
                           "16777217",
                           "16777217.00000000000000000001",
                           "16777216.99999999999999999999",
                           "0",
                           "-0",
                           "+7",
                           ".5",
                           "5.",
                           "1e5",
                           "1E+5",
                           "000000000000000000000000012.5"}) {
    INFO(text);
    CHECK(std::bit_cast<uint32_t>(read_whole(text).value) ==
          std::bit_cast<uint32_t>(std::strtof(text, nullptr)));
  }
  CHECK(read_whole("0." + std::string(400, '0') + "1").value == 0);
  CHECK(read_whole("1" + std::string(400, '0')).value == HUGE_VALF);
  CHECK(read_whole("1" + std::string(400, '0') + "e-399").value == 10);
  CHECK(read_whole("0." + std::string(399, '0') + "1e401").value == 10);
  CHECK(std::isinf(read_whole("1e99999999999999999999").value));
  CHECK(read_whole("1e-99999999999999999999").value == 0);
  CHECK(std::isnan(read_whole("nan").value));
}

TEST_CASE("Fortran's exponents are read") {
  CHECK(read_whole("1.5D+02").value == 150);
  CHECK(read_whole("-1.5d-1").value == -0.15f);
}

TEST_CASE("a number ends at a blank, an end of line or a backslash, or is none") {
  for (const char* end : {" ", "\t", "\n", "\r", "\\\n"}) {
    const std::string text = std::string("1.5") + end;
    Real out;
    CHECK(read_real(text.data(), text.data() + text.size(), out) == text.data() + 3);
  }
  for (const char* text :
       {"",      " ",     "-",        "+",       ".",       "-.",   "e5",          "1e",  "1e+",
        "0,5",   "2.5+3", "1.#IND00", "-1.#IND", "1.#QNAN", "1.5D", "1.5D+02D+02", "+-1", "--1",
        "1.2.3", "0x10",  "1_000",    "1.5f",    "12a",     "1/2",  "1\xc2\xa0"}) {
    INFO(text);
    Real out;
    const std::string number = text;
    CHECK(read_real(number.data(), number.data() + number.size(), out) == nullptr);
  }
}

TEST_CASE("a binary32 value has no remainder, however it is printed") {
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    const float value = random_float(random, -20, 24);
    for (const char* format : {"%.0f", "%.1f", "%.4f", "%.6f", "%.9f", "%.3g", "%.6g", "%.9g",
                               "%.16g", "%.17g", "%.20f", "%.7e", "%.40e"}) {
      const std::string text = print(format, value);
      INFO(text);
      CHECK(read_whole(text).remainder == 0);
    }
  }
}

TEST_CASE("what binary32 does not hold of a decimal is its remainder") {
  // The spacing of binary32 is 0.25 there.
  const Real far = read_whole("-2487002.881739");
  CHECK(far.value == -2487003);
  CHECK(far.remainder == Approx(0.118261));
  CHECK(read_whole("-2487002.881739e0").remainder == Approx(0.118261));
  CHECK(read_whole("-0.2487002881739D+07").remainder == Approx(0.118261));
  CHECK(read_whole("16777217").remainder == 1);
  CHECK(read_whole("16777217.0000000000000001").remainder == -1);
  // 0.1 says no more than that it is between 0.05 and 0.15.
  CHECK(read_whole("0.1").remainder == 0);
  CHECK(read_whole("0.1000000000").remainder == Approx(0.1 - double{0.1f}));

  std::mt19937 random(3);
  for (int i = 0; i < 5000; ++i) {
    const double value = std::uniform_real_distribution<>(-1000, 1000)(random);
    const std::string text = print("%.13f", value);
    const Real read = read_whole(text);
    const double remainder = std::strtod(text.c_str(), nullptr) - double{read.value};
    INFO(text);
    CHECK(double{read.remainder} == Approx(remainder).margin(1e-13));
  }
}

TEST_CASE("lines are counted whatever ends them") {
  for (const char* end : {"\n", "\r", "\r\n", "\n\r", "\r\r\n"}) {
    const std::string text = std::string("a") + end + "b c" + end + "d";
    TextCursor in(text);
    CHECK(in.error("x").message() == "line 1: x");
    in.next_line();
    CHECK(in.word() == "b");
    CHECK(in.error("x").message() == "line 2: x");
    in.next_line();
    CHECK(in.word() == "d");
    CHECK(in.error("x").message() == "line 3: x");
  }
}

TEST_CASE("lines continue behind a backslash and blanks") {
  for (const char* end : {"\\\n", "\\\r", "\\\r\n", "\\\n\r", "\\ \t\n", "\\\n\\\n"}) {
    TextCursor in(std::string_view("1"));
    const std::string text = std::string("1 ") + end + "2";
    in = TextCursor(text);
    int first = 0;
    int second = 0;
    CHECK(in.read(first));
    in.skip_blanks_and_continuations();
    CHECK(in.read(second));
    CHECK(second == 2);
  }
}

}  // namespace reeb::tools
