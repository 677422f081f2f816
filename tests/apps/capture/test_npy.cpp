#include "apps/capture/npy.h"
#include "apps/capture/npz.h"
#include "core/base/errors.h"
#include "core/base/file.h"

#include "catch.h"
#include "python.h"
#include "scratch.h"

#include <cstring>

using namespace lrsm;

namespace {

std::vector<std::byte> counting(std::size_t n)
{
    std::vector<std::byte> bytes(n);
    for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::byte>(i * 7 + 1);
    return bytes;
}

std::string_view textOf(const std::vector<std::byte>& bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A file with this header text, padded as the format asks.
std::vector<std::byte> fileWithHeader(std::string header, std::size_t dataBytes, char major = 1)
{
    header += '\n';
    std::string text = std::string("\x93NUMPY") + major + '\0' + static_cast<char>(header.size() & 255) + static_cast<char>(header.size() >> 8) + header;
    text.append(dataBytes, '\0');
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

std::string messageOfNpy(const std::vector<std::byte>& file)
{
    try {
        decodeNpy(file, "a.npy");
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

}  // namespace

TEST_CASE("npy: every type and rank reads back as written, data aligned to 64", "[capture][npy]")
{
    const auto dtype = GENERATE(Dtype::u1, Dtype::u2, Dtype::u4, Dtype::u8, Dtype::i4, Dtype::f2, Dtype::f4, Dtype::f8);
    const auto shape = GENERATE(values<std::vector<std::size_t>>({{}, {5}, {2, 3}, {4, 0, 2}, {1, 2, 3, 4}}));
    const std::vector<std::byte> bytes = counting(elementCount(shape, "test") * sizeOf(dtype));
    const std::vector<std::byte> file = encodeNpy(dtype, shape, bytes);
    CHECK((file.size() - bytes.size()) % 64 == 0);
    CHECK(file.size() == npyHeader(dtype, shape).size() + bytes.size());
    const NpyArray array = decodeNpy(file, "test");
    CHECK(array.dtype == dtype);
    CHECK(array.shape == shape);
    CHECK(array.bytes == bytes);
}

TEST_CASE("npy: the header is byte for byte the one of numpy.save", "[capture][npy]")
{
    // From numpy 1.24: numpy.save(f, numpy.zeros((2, 3), '<f4')).
    const std::string expected = std::string("\x93NUMPY\x01\x00v\x00", 10) + "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
    const std::vector<std::byte> file = encodeNpy(Dtype::f4, {2, 3}, counting(24));
    CHECK(textOf(file).substr(0, expected.size()) == expected);
    CHECK(textOf(file).substr(expected.size(), 128 - expected.size()) == std::string(127 - expected.size(), ' ') + "\n");
    CHECK(file.size() == 128 + 24);
}

TEST_CASE("npy: numpy reads the very values, and we read numpy's files", "[capture][npy]")
{
    LRSM_NEED_PYTHON(python, "numpy");
    ScratchFolder scratch;
    const std::vector<float> values = {0.0f, -0.0f, 1.5f, -3.25e-20f, 65504.0f, 1e-42f};
    scratch.write("f4.npy", textOf(encodeNpy(Dtype::f4, {3, 2}, std::as_bytes(std::span(values)))));
    scratch.write("u8.npy", textOf(encodeNpy(Dtype::u8, {1}, counting(8))));
    const std::string script = "import numpy as n; a = n.load('" + scratch.path("f4.npy") +
                               "'); assert a.dtype == '<f4' and a.shape == (3, 2); "
                               "assert a.tobytes() == n.array([0, -0.0, 1.5, -3.25e-20, 65504, 1e-42], '<f4').tobytes(); "
                               "assert n.load('" +
                               scratch.path("u8.npy") +
                               "')[0] == 0x322b241d160f0801; "
                               "n.save('" +
                               scratch.path("back.npy") +
                               "', n.arange(24, dtype='<u2').reshape(2, 3, 4)); "
                               "n.save('" +
                               scratch.path("fortran.npy") +
                               "', n.asfortranarray(n.zeros((2, 3), '<f4'))); "
                               "n.save('" +
                               scratch.path("big.npy") + "', n.zeros(3, '>f4'))";
    const CommandOutcome outcome = runCommand(python + " -c \"" + script + "\"");
    INFO(outcome.text);
    REQUIRE(outcome.code == 0);
    const NpyArray back = readNpy(scratch.path("back.npy"));
    CHECK(back.shape == std::vector<std::size_t>{2, 3, 4});
    CHECK(std::to_integer<int>(back.bytes[2 * 23]) == 23);
    CHECK(readNpy(scratch.path("fortran.npy")).shape == std::vector<std::size_t>{2, 3});
    CHECK(readNpy(scratch.path("big.npy")).dtype == Dtype::f4);
}

TEST_CASE("npy: malformed files give one line that begins with the place", "[capture][npy]")
{
    const std::string good = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
    CHECK(messageOfNpy(fileWithHeader(good, 24)) == "read");
    struct Case {
        std::vector<std::byte> file;
        std::string why;
    };
    const std::vector<Case> cases = {
        {{}, "no .npy"},
        {counting(40), "no .npy"},
        {fileWithHeader(good, 24, 4), "version 4.0"},
        {fileWithHeader(good, 23), "holds 23 bytes"},
        {fileWithHeader(good, 25), "holds 25 bytes"},
        {fileWithHeader("{'descr': '<c8', 'fortran_order': False, 'shape': (3,), }", 24), "'<c8'"},
        {fileWithHeader("{'descr': '<U3', 'fortran_order': False, 'shape': (2,), }", 24), "text"},
        {fileWithHeader("{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", 24), "Python objects"},
        {fileWithHeader("{'descr': '<f16', 'fortran_order': False, 'shape': (2,), }", 32), "differs between machines"},
        {fileWithHeader("{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (3,), }", 24), "records"},
        {fileWithHeader("{'descr': '<f4', 'shape': (2, 3), }", 24), "lacks"},
        {fileWithHeader("{'descr': '<f4', 'fortran_order': False, 'shape': (2, -3), }", 24), "no size"},
        {fileWithHeader("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999, 99999999999), }", 24), "larger than any file"},
        {fileWithHeader("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1, 1, 1, 1, 1, 1, 1), }", 4), "axes"},
        {fileWithHeader("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)", 24), "npy"},
        {fileWithHeader("{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", 24), "unexpected key"},
        {fileWithHeader(good + " + 1", 24), "text follows"},
    };
    for (const Case& c : cases) {
        const std::string message = messageOfNpy(c.file);
        CAPTURE(c.why, message);
        CHECK(message.starts_with("a.npy"));
        CHECK(message.find(c.why) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
    std::vector<std::byte> cut = fileWithHeader(good, 0);
    cut.resize(40);
    CHECK(messageOfNpy(cut).find("within its header") != std::string::npos);
}

namespace {

/// The bytes of a whole number of `size` bytes, lowest first; of a float of the same value.
std::vector<std::byte> bytesOfNumber(const std::string& kind, std::size_t size, int value)
{
    std::vector<std::byte> bytes(size);
    const auto take = [&](auto number) { std::memcpy(bytes.data(), &number, size); };
    if (kind != "f")
        take(std::int64_t(value));
    else if (size == 4)
        take(float(value));
    else if (size == 8)
        take(double(value));
    else  // 0 .. 23 as binary16: exponent and mantissa from the float's
        take(std::uint16_t(value == 0 ? 0 : [&] {
            std::uint32_t bits = 0;
            const auto wide = float(value);
            std::memcpy(&bits, &wide, 4);
            return ((bits >> 23) - 112) << 10 | (bits >> 13 & 0x3ff);
        }()));
    return bytes;
}

}  // namespace

TEST_CASE("npy: any type, byte order, axis order and version gives the same array", "[capture][npy]")
{
    // Element (i, j, k) of (2, 3, 4) is 12 i + 4 j + k, in the file at the place that the order asks for.
    const auto type = GENERATE(values<std::string>({"b1", "u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f4", "f8"}));
    const bool big = GENERATE(false, true), fortran = GENERATE(false, true);
    const int version = GENERATE(1, 2, 3);
    const std::size_t size = std::size_t(type[1] - '0');
    std::vector<std::byte> inC, inFile(24 * size);
    for (std::size_t i = 0, n = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 4; ++k, ++n) {
                const std::vector<std::byte> little = bytesOfNumber(type.substr(0, 1), size, type == "b1" ? int(n % 2) : int(n));
                inC.insert(inC.end(), little.begin(), little.end());
                const std::size_t at = fortran ? i + 2 * j + 6 * k : n;
                for (std::size_t b = 0; b < size; ++b) inFile[at * size + b] = little[big ? size - 1 - b : b];
            }
    const std::string order = size == 1 ? "|" : big ? ">" : "<", quote = version == 3 ? "\"" : "'";
    std::string header = "{" + quote + "descr" + quote + ": " + quote + order + type + quote + ", 'shape': (2, 3, " + (version == 1 ? "4L" : "4") +
                         "), 'fortran_order': " + (fortran ? "True" : "False") + "}\t\n";
    std::string text = std::string("\x93NUMPY") + char(version) + '\0' + char(header.size()) + '\0' + (version > 1 ? std::string(2, '\0') : "") + header;
    text.append(reinterpret_cast<const char*>(inFile.data()), inFile.size());
    CAPTURE(header, version);
    const NpyArray array = decodeNpy(std::as_bytes(std::span(text)), "a.npy");
    CHECK(array.dtype == dtypeByName(type, "test"));
    CHECK(array.shape == std::vector<std::size_t>{2, 3, 4});
    CHECK(array.bytes == inC);
}

TEST_CASE("npz: arrays of zips that Python wrote, stored and deflated, damaged ones are one line", "[capture][npy]")
{
    LRSM_NEED_PYTHON(python, "zipfile");
    ScratchFolder scratch;
    const std::vector<float> values = {1.0f, 2.0f, -3.5f};
    scratch.write("a.npy", textOf(encodeNpy(Dtype::f4, {3}, std::as_bytes(std::span(values)))));
    const std::string script = "import zipfile as z, sys; f = z.ZipFile('" + scratch.path("a.npz") + "', 'w'); f.write('" + scratch.path("a.npy") +
                               "', 'gbuffer.depth.npy'); f.write('" + scratch.path("a.npy") + "', 'arr_0.npy', z.ZIP_DEFLATED); f.close()";
    REQUIRE(runCommand(python + " -c \"" + script + "\"").code == 0);
    CHECK(namesInNpz(scratch.path("a.npz")) == std::vector<std::string>{"gbuffer.depth", "arr_0"});
    for (const char* name : {"gbuffer.depth", "arr_0"}) CHECK(readNpz(scratch.path("a.npz"), name).bytes.size() == 12);
    CHECK_THROWS_AS(readNpz(scratch.path("a.npz"), "b"), InputError);
    scratch.write("b.npz", "PK nonsense");
    CHECK_THROWS_AS(namesInNpz(scratch.path("b.npz")), InputError);
    // A byte of the stored array changed: the checksum tells.
    const std::vector<unsigned char> whole = readFile(scratch.path("a.npz"));
    std::string file(whole.begin(), whole.end());
    file[file.find("NUMPY") + 70] = '!';
    scratch.write("c.npz", file);
    CHECK_THROWS_AS(readNpz(scratch.path("c.npz"), "gbuffer.depth"), InputError);
}
