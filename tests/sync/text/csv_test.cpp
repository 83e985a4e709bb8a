// Tests of reading CSV tables.
#include "sync/text/csv.h"

#include <catch2/catch.hpp>
#include <fstream>

#include <unistd.h>

using namespace tactus::sync;
using Cells = std::vector<std::string>;

TEST_CASE("A line is split at its commas, and a cell may be empty") {
  CHECK(csv_cells("a,b,,c") == Cells{"a", "b", "", "c"});
  CHECK(csv_cells("") == Cells{""});
  CHECK(csv_cells(",") == Cells{"", ""});
}

TEST_CASE("A cell is never a formula of a spreadsheet, and numbers stay numbers") {
  for (const char* text : {"=HYPERLINK(1)", "+cmd|' /C calc'!A0", "-2+3", "@SUM(1)", "\t=1", "\r=1"}) {
    INFO(text);
    CHECK(csv_cells(csv_cell(text)) == Cells{std::string("'") + text});
  }
  for (const char* text : {"", "-", "=", "plain", "-5", "+1.5", "-2.5e-3", "1-2", "'quoted'"}) {
    INFO(text);
    CHECK(csv_cell(text) == text);
  }
  CHECK(csv_cell("'=1") == "''=1");  // the escape can be undone
  CHECK(csv_cell("=1,2") == "\"'=1,2\"");
}

TEST_CASE("A quoted cell may contain commas and doubled quotes") {
  CHECK(csv_cells(R"("a, b",c)") == Cells{"a, b", "c"});
  CHECK(csv_cells(R"("say ""so""",2)") == Cells{R"(say "so")", "2"});
  CHECK(csv_cells(R"("")") == Cells{""});
}

TEST_CASE("The byte order mark and carriage return of a line are removed") {
  CHECK(csv_cells("\xef\xbb\xbfname,x_m\r") == Cells{"name", "x_m"});
}

TEST_CASE("A line without content is blank") {
  for (const char* line : {"", "\r", "  ", ",,", " ,\t,\r"}) CHECK(is_blank(csv_cells(line)));
  for (const char* line : {"0", ",a", "-"}) CHECK_FALSE(is_blank(csv_cells(line)));
}

TEST_CASE("A cell is a number only if all of it is one finite number") {
  CHECK(csv_number("1.5e-3") == 1.5e-3);
  CHECK(csv_number("-7") == -7);
  for (const char* none : {"", " 1", "1 ", "1,5", "0x", "nan", "inf", "1e999", "one"})
    CHECK_FALSE(csv_number(none));
}

TEST_CASE("A file is read completely, or not at all if it is too large, missing or endless") {
  const auto file = std::filesystem::temp_directory_path() / ("csv_test." + std::to_string(::getpid()));
  std::ofstream(file) << "four";
  CHECK(read_small_file(file, 4) == "four");
  CHECK_FALSE(read_small_file(file, 3));
  std::ofstream(file, std::ios::trunc);
  CHECK(read_small_file(file, 3) == "");
  std::filesystem::remove(file);
  CHECK_FALSE(read_small_file(file, 3));
  CHECK_FALSE(read_small_file("/dev/zero", 3));
  CHECK_FALSE(read_small_file(std::filesystem::temp_directory_path(), 1 << 30));
}
