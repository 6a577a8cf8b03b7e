#define _GNU_SOURCE
#include "bench/peer.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "app/scene/listing.h"

const char *const peer_names[PEER_KINDS] = {"Embree", "the driver's own ray tracing"};
static const char *const programs[PEER_KINDS] = {"whit-embree", "whit-ray-pipeline"};

static bool find_program(enum peer_kind kind, char *path, size_t bytes)
{
    char program[2048];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = 0;
    char *slash = strrchr(program, '/');
    if (slash)
        snprintf(path, bytes, "%.*s/%s", (int)(slash - program), program, programs[kind]);
    return slash && access(path, X_OK) == 0;
}

const char *peer_why_not(enum peer_kind kind, const whit_scene_info *scene)
{
    static const char *const missing[PEER_KINDS] = {
        "`whit-embree` is not beside whit-bench; the build makes it where Embree 3 is installed "
        "(Debian: libembree-dev)",
        "`whit-ray-pipeline` is not beside whit-bench"};
    char path[BENCH_PATH];
    if (!find_program(kind, path, sizeof path))
        return missing[kind];
    return scene && scene->sphere_count ? "its side has triangles alone, not spheres" : NULL;
}

/* Waits until the peer ends, and gives the error. */
static whit_result lost(struct peer *peer)
{
    whit_result result = process_end(&peer->process, NULL);
    if (result == WHIT_OK)
        cli_error("`%s` ended too soon", programs[peer->kind]);
    return result == WHIT_OK ? WHIT_ERROR_FAILED : result;
}

static whit_result read_answer(struct peer *peer, char *answer, size_t bytes, const char *word)
{
    if (!fgets(answer, (int)bytes, peer->answers))
        return lost(peer);
    answer[strcspn(answer, "\n")] = 0;
    if (strncmp(answer, word, strlen(word)) == 0 || strncmp(answer, "none", 4) == 0)
        return cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
    return CLI_FAIL(WHIT_ERROR_FAILED, "`%s` answers `%s`", programs[peer->kind],
                    cli_shown(answer));
}

static whit_result WHIT_PRINTF(4, 5)
    ask(struct peer *peer, char answer[128], const char *word, const char *format, ...)
{
    char line[1024];
    va_list args;
    va_start(args, format);
    int length = vsnprintf(line, sizeof line, format, args);
    va_end(args);
    if (send(peer->socket, line, (size_t)length, MSG_NOSIGNAL) != length)
        return lost(peer);
    return read_answer(peer, answer, 128, word);
}

static whit_result start(struct peer *peer, const struct bench *bench, const char *triangles)
{
    int ends[2];
    if (!find_program(peer->kind, peer->program, sizeof peer->program) ||
        socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return CLI_FAIL(WHIT_ERROR_MEMORY, "no `%s`, or no socket for it: %s", programs[peer->kind],
                        strerror(errno));
    peer->process =
        (struct process){.program = peer->program, .folder = bench->folder, .socket = ends[1]};
    process_add(&peer->process, programs[peer->kind], triangles,
                peer->kind == PEER_PIPELINE ? peer->device : NULL, NULL);
    peer->socket = ends[0];
    peer->answers = fdopen(ends[0], "r");
    whit_result result = peer->answers ? process_start(&peer->process) : WHIT_ERROR_MEMORY;
    close(ends[1]);
    return result;
}

whit_result peer_begin(struct peer *peer, enum peer_kind kind, const struct bench *bench,
                       const whit_scene *scene, const char *triangles)
{
    char answer[256] = "", path[BENCH_PATH];
    *peer = (struct peer){.kind = kind, .socket = -1};
    snprintf(peer->device, sizeof peer->device, "%u", bench->device_info.index);
    bench_file(bench, triangles, path);
    whit_result result = triangles_write(scene, 0.0, path);
    if (result == WHIT_OK)
        result = start(peer, bench, triangles);
    if (result == WHIT_OK)
        result = read_answer(peer, answer, sizeof answer, "ready ");
    if (result == WHIT_OK) /* after `ready ` or `none ` */
        snprintf(answer[0] == 'r' ? peer->version : peer->why_not, sizeof peer->version, "%s",
                 answer + (answer[0] == 'r' ? 6 : 5));
    return result;
}

/* A peer ends when its input is closed. */
void peer_end(struct peer *peer)
{
    if (peer->answers)
        fclose(peer->answers);
    else if (peer->socket > 0)
        close(peer->socket);
    peer->process.is_tried = true;
    if (peer->process.pid)
        (void)!process_end(&peer->process, NULL);
    *peer = (struct peer){0};
}

whit_result peer_rays(struct peer *peer, const char *name, bool any)
{
    char answer[128];
    return ask(peer, answer, "rays ", "rays %s %s\n", name, any ? "any" : "closest");
}

whit_result peer_hits(struct peer *peer, const char *name)
{
    char answer[128];
    return ask(peer, answer, "hits ", "hits %s\n", name);
}

whit_result peer_trace(struct peer *peer, const char *way, bool back, bool coherent, double ms[2])
{
    char answer[128];
    ms[0] = ms[1] = -1.0;
    whit_result result = ask(peer, answer, "time ", "trace %s %s %s\n", way,
                             back ? "back" : "forth", coherent ? "coherent" : "scattered");
    if (result == WHIT_OK && answer[0] == 't')
        sscanf(answer, "time %lf %lf", &ms[0], &ms[1]);
    return result;
}

whit_result peer_build(struct peer *peer, const char *quality, uint32_t threads, double *ms,
                       double *bytes)
{
    char answer[128];
    whit_result result = ask(peer, answer, "built ", "build %s %u\n", quality, threads);
    if (result == WHIT_OK)
        sscanf(answer, "built %lf %lf", ms, bytes);
    return result;
}
