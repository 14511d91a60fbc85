// SPDX-License-Identifier: Apache-2.0
//
// The main program of all tests. With --list-for-ctest it runs none, but prints what there are.

#include <cstring>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

/// tests/a/b_test.cpp as a/b.
std::string NameFile(std::filesystem::path const& file) {
    std::string const name = file.lexically_relative(LIMN_SOURCE_DIR "/tests").string();
    return name.substr(0, name.size() - std::strlen("_test.cpp"));
}

/// A line per test, see list_tests.cmake.in. The file is named that a test stands in, so that names
/// do not depend on which files are compiled into one program.
void ListTests() {
    testing::UnitTest const& all = *testing::UnitTest::GetInstance();
    for (int i = 0; i < all.total_test_suite_count(); ++i) {
        testing::TestSuite const& suite = *all.GetTestSuite(i);
        for (int k = 0; k < suite.total_test_count(); ++k) {
            testing::TestInfo const& test = *suite.GetTestInfo(k);
            fmt::print("limn_add_test({} {}.{})\n", NameFile(test.file()), suite.name(),
                       test.name());
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    if (argc == 2 && std::strcmp(argv[1], "--list-for-ctest") == 0) {
        ListTests();
        return 0;
    }
    return RUN_ALL_TESTS();
}
