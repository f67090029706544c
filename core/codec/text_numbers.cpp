#include "codec/text_numbers.h"

#include <charconv>
#include <version>
#ifndef __cpp_lib_to_chars  // libc++ before LLVM 20 reads whole numbers alone
#include <locale.h>
#include <stdlib.h>
#if __has_include(<xlocale.h>)
#include <xlocale.h>
#endif
#endif

namespace dg {
namespace {

constexpr bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

constexpr bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool read(const char* begin, const char* end, std::int64_t& value) {
    const auto [stop, error] = std::from_chars(begin, end, value);
    return error == std::errc() && stop == end;
}

bool read(const char* begin, const char* end, double& value) {
#ifdef __cpp_lib_to_chars
    const auto [stop, error] = std::from_chars(begin, end, value);
    return error == std::errc() && stop == end;
#else
    static const locale_t plain = newlocale(LC_ALL_MASK, "C", locale_t(0));
    char word[64];  // longer words are left to the caller
    const std::size_t size = std::size_t(end - begin);
    if (size >= sizeof word) return false;
    for (std::size_t i = 0; i < size; ++i) {
        if (begin[i] == 'x' || begin[i] == 'X') return false;
        word[i] = begin[i];
    }
    word[size] = 0;
    char* stop = nullptr;
    value = strtod_l(word, &stop, plain);
    return stop == word + size && value - value == 0;
#endif
}

template <typename T>
TextNumbers<T> numbers(Bytes text) {
    const char* const first = reinterpret_cast<const char*>(text.data());
    const char* const last = first + text.size();
    TextNumbers<T> found;
    for (const char* at = first;;) {
        while (at != last && is_blank(*at)) ++at;
        found.end = std::size_t(at - first);
        if (at == last) return found;
        const char* end = at;
        while (end != last && !is_blank(*end)) ++end;
        const char* const digits = at + (*at == '+' || *at == '-');
        T value;
        if (digits == end || !(is_digit(*digits) || *digits == '.')) return found;
        if (!read(*at == '+' ? digits : at, end, value)) return found;
        found.values.push_back(value);
        at = end;
    }
}

}  // namespace

TextNumbers<double> text_floats(Bytes text) {
    return numbers<double>(text);
}

TextNumbers<std::int64_t> text_integers(Bytes text) {
    return numbers<std::int64_t>(text);
}

}  // namespace dg
