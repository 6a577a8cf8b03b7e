#include "shader/pack.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/hash.h"
#include "base/text.h"

static const char head[] = "\\whit 1", file_mark[] = "\\file ", end_mark[] = "\\end ";

/* ---- Names ---- */

/* Whether it is the name of a device on some other system, with any extension. */
static bool is_device(const char *part, size_t length)
{
    static const char *const names[] = {"con", "prn", "aux", "nul", "conin$", "conout$"};
    size_t stem = 0;
    while (stem < length && part[stem] != '.' && part[stem] != ' ')
        stem++;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (stem == strlen(names[i]) && strncasecmp(part, names[i], stem) == 0)
            return true;
    }
    return stem == 4 && isdigit((unsigned char)part[3]) &&
           (strncasecmp(part, "com", 3) == 0 || strncasecmp(part, "lpt", 3) == 0);
}

static const char *refuse_part(const char *part, size_t length)
{
    if (length == 0)
        return "a name without a name in it";
    if (part[0] == '.' && (length == 1 || (length == 2 && part[1] == '.')))
        return "a name that leads out of the folder";
    if (part[0] == '.') /* programs obey some: git runs what a .git/config names */
        return "a hidden name";
    if (is_device(part, length))
        return "the name of a device";
    return length > 255 ? "a name that is too long" : NULL;
}

const char *shader_pack_name_refused(const char *name)
{
    if (strlen(name) >= SHADER_PACK_NAME_BYTES)
        return "a name that is too long";
    if (name[0] == '/')
        return "an absolute name";
    for (const char *c = name; *c; ++c) {
        if ((unsigned char)*c < ' ' || *c == 127 || strchr("\\:*?\"<>|", *c))
            return "a character that names have not everywhere";
    }
    for (const char *part = name;;) {
        size_t length = strcspn(part, "/");
        const char *why = refuse_part(part, length);
        if (why || !part[length])
            return why;
        part += length + 1;
    }
}

/* ---- Writing ---- */

/* Without `out`, bytes are only counted. */
struct writing {
    char *out;
    size_t used;
};

static void put_byte(struct writing *w, char byte)
{
    if (w->out)
        w->out[w->used] = byte;
    w->used++;
}

static void put(struct writing *w, const char *text)
{
    for (; *text; ++text)
        put_byte(w, *text);
}

static void put_escaped(struct writing *w, const char *text, size_t bytes)
{
    static const char digits[] = "0123456789abcdef";
    for (size_t i = 0; i < bytes; ++i) {
        unsigned char c = (unsigned char)text[i];
        if (c == '\\') {
            put(w, "\\\\");
        } else if (c == '\n' || c == '\t' || (c >= ' ' && c <= '~')) {
            put_byte(w, (char)c);
        } else {
            put(w, "\\x");
            put_byte(w, digits[c >> 4]);
            put_byte(w, digits[c & 15]);
        }
    }
}

static void put_all(struct writing *w, const struct shader_text *text)
{
    char number[24];
    put(w, head);
    for (uint32_t i = 0; i < text->file_count && w->used <= SHADER_PACK_BYTES; ++i) {
        const struct shader_file *file = &text->files[i];
        put(w, "\n");
        put(w, file_mark);
        put_escaped(w, file->relative, strlen(file->relative));
        put(w, "\n");
        put_escaped(w, file->raw, file->bytes);
    }
    snprintf(number, sizeof number, "%016" PRIx64, shader_text_hash(text));
    put(w, "\n");
    put(w, end_mark);
    put(w, number);
}

char *shader_pack_write(const struct shader_text *text, const char **why)
{
    struct writing counted = {0};
    for (uint32_t i = 0; i < text->file_count; ++i) {
        *why = shader_pack_name_refused(text->files[i].relative);
        if (*why)
            return NULL;
    }
    put_all(&counted, text);
    *why = "they are larger than 1 MiB";
    if (counted.used > SHADER_PACK_BYTES)
        return NULL;
    struct writing written = {.out = malloc(counted.used + 1)};
    *why = "out of memory";
    if (!written.out)
        return NULL;
    put_all(&written, text);
    written.out[written.used] = 0;
    *why = NULL;
    return written.out;
}

/* ---- Reading ---- */

struct unpacking {
    const whit_log *log;
    const char *where;
    const char *at;
    char *out; /* points into pack->bytes, which is large enough */
    struct shader_pack *pack;
};

static bool refuse(struct unpacking *u, const char *why, const char *name)
{
    if (name)
        log_error(u->log, "%s: the functions in it are damaged: `%s`: %s", u->where,
                  text_token(name).text, why);
    else
        log_error(u->log, "%s: the functions in it are damaged: %s", u->where, why);
    return false;
}

static int digit_of(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

static bool starts_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

/* Decodes one packed byte. */
static bool take_byte(struct unpacking *u)
{
    const char *at = u->at;
    unsigned char c = (unsigned char)*at;
    if (c == '\\' && at[1] == '\\') {
        *u->out++ = '\\';
        u->at += 2;
    } else if (c == '\\' && at[1] == 'x' && digit_of(at[2]) >= 0 && digit_of(at[3]) >= 0) {
        *u->out++ = (char)(digit_of(at[2]) << 4 | digit_of(at[3]));
        u->at += 4;
    } else if (c != '\\' && (c == '\n' || c == '\t' || (c >= ' ' && c <= '~'))) {
        *u->out++ = (char)c;
        u->at++;
    } else {
        return refuse(u, c ? "a byte that is written otherwise" : "they are cut short", NULL);
    }
    return true;
}

static bool take_name(struct unpacking *u, const char **name)
{
    *name = u->out;
    while (*u->at != '\n') {
        if (!take_byte(u))
            return false;
    }
    if (memchr(*name, 0, (size_t)(u->out - *name)))
        return refuse(u, "a name with a byte 0", NULL);
    *u->out++ = 0;
    u->at++;
    const char *why = shader_pack_name_refused(*name);
    return !why || refuse(u, why, *name);
}

/* Whether `a` is `b`, or a folder that `b` is in. */
static bool covers(const char *a, const char *b)
{
    size_t length = strlen(a);
    return strncmp(a, b, length) == 0 && (!b[length] || b[length] == '/');
}

static bool take_file(struct unpacking *u)
{
    struct shader_pack *pack = u->pack;
    struct shader_text_source *source = &pack->sources[pack->count];
    if (pack->count == SHADER_TEXT_FILES_MAX)
        return refuse(u, "more than 64 files", NULL);
    if (!take_name(u, &source->relative))
        return false;
    for (uint32_t i = 0; i < pack->count; ++i) {
        if (covers(pack->sources[i].relative, source->relative) ||
            covers(source->relative, pack->sources[i].relative))
            return refuse(u, "the name of two files", source->relative);
    }
    source->text = u->out;
    while (u->at[0] != '\n' ||
           !(starts_with(u->at + 1, file_mark) || starts_with(u->at + 1, end_mark))) {
        if (!take_byte(u))
            return false;
    }
    source->bytes = (size_t)(u->out - source->text);
    *u->out++ = 0;
    u->at++;
    pack->count++;
    return true;
}

static uint64_t hash_of(const struct shader_pack *pack)
{
    uint64_t hash = HASH_START;
    for (uint32_t i = 0; i < pack->count; ++i) {
        hash = hash_bytes(hash, pack->sources[i].relative, strlen(pack->sources[i].relative));
        hash = hash_bytes(hash, pack->sources[i].text, pack->sources[i].bytes);
    }
    return hash;
}

static bool take_end(struct unpacking *u)
{
    char number[24];
    snprintf(number, sizeof number, "%016" PRIx64, hash_of(u->pack));
    return strcmp(u->at + strlen(end_mark), number) == 0 ||
           refuse(u, "they are not what was put there", NULL);
}

static bool take_all(struct unpacking *u)
{
    if (!starts_with(u->at, head) || u->at[sizeof head - 1] != '\n')
        return refuse(u,
                      starts_with(u->at, "\\whit ") ? "another version of whit wrote them"
                                                    : "they do not begin as such",
                      NULL);
    u->at += sizeof head;
    while (starts_with(u->at, file_mark)) {
        u->at += strlen(file_mark);
        if (!take_file(u))
            return false;
    }
    if (!u->pack->count)
        return refuse(u, "there is no file", NULL);
    return take_end(u);
}

whit_result shader_pack_read(const whit_log *log, const char *where, const char *packed,
                             struct shader_pack *pack)
{
    *pack = (struct shader_pack){0};
    struct unpacking u = {.log = log, .where = where, .at = packed, .pack = pack};
    size_t bytes = strlen(packed);
    if (bytes > SHADER_PACK_BYTES) {
        refuse(&u, "they are larger than 1 MiB", NULL);
        return WHIT_ERROR_INPUT;
    }
    pack->bytes = u.out = malloc(bytes + 1);
    if (!pack->bytes)
        return log_failure(log, WHIT_ERROR_MEMORY, "%s: out of memory", where);
    if (take_all(&u))
        return WHIT_OK;
    shader_pack_free(pack);
    return WHIT_ERROR_INPUT;
}

void shader_pack_free(struct shader_pack *pack)
{
    free(pack->bytes);
    *pack = (struct shader_pack){0};
}
