//! A static host as plain as they come: files of one folder, no headers but type and length.
//!
//! It listens on this machine only, never leaves its folder, and can put the folder under any path, as a host such
//! as GitHub Pages does.

use anyhow::{Context, Result};
use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A bound address, not yet answering.
pub struct Server {
    listener: TcpListener,
    folder: PathBuf,
    /// The path of the folder's address: starts and ends with `/`.
    prefix: String,
}

impl Server {
    /// Binds the first free port from `ports` on 127.0.0.1.
    pub fn bind(folder: &Path, prefix: &str, ports: impl IntoIterator<Item = u16>) -> Result<Self> {
        let mut error = None;
        for port in ports {
            match TcpListener::bind((Ipv4Addr::LOCALHOST, port)) {
                Ok(listener) => return Ok(Self { listener, folder: folder.to_owned(), prefix: prefix.to_owned() }),
                Err(reason) => error = Some(anyhow::Error::from(reason).context(format!("port {port}"))),
            }
        }
        Err(error.unwrap_or_else(|| anyhow::anyhow!("no port was given"))).context("no port is free on 127.0.0.1")
    }

    /// The address of the folder.
    pub fn address(&self) -> Result<String> {
        Ok(format!("http://{}{}", self.listener.local_addr()?, self.prefix))
    }

    /// Answers as long as this program runs, and returns the address.
    pub fn run_behind(self) -> Result<String> {
        let address = self.address()?;
        std::thread::spawn(|| self.run());
        Ok(address)
    }

    /// Answers for ever, each connection on its own thread.
    pub fn run(self) {
        let (folder, prefix) = (std::sync::Arc::new(self.folder), std::sync::Arc::new(self.prefix));
        for stream in self.listener.incoming().flatten() {
            let (folder, prefix) = (folder.clone(), prefix.clone());
            // A browser that goes away in the middle is no concern of the server's.
            std::thread::spawn(move || drop(answer(&stream, &folder, &prefix)));
        }
    }
}

/// Answers the requests of one connection, one after the other, until it is closed or silent for long.
fn answer(stream: &TcpStream, folder: &Path, prefix: &str) -> std::io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(30)))?;
    stream.set_nodelay(true)?;
    let mut reader = BufReader::new(stream);
    loop {
        let mut request = String::new();
        if reader.read_line(&mut request)? == 0 {
            return Ok(());
        }
        loop {
            let mut header = String::new();
            if reader.read_line(&mut header)? == 0 || header.trim().is_empty() {
                break;
            }
        }
        let mut words = request.split_whitespace();
        let (method, target) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let (status, kind, body) = respond(method, target, folder, prefix);
        let head = format!(
            "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-cache\r\n\r\n",
            body.len()
        );
        let mut out = head.into_bytes();
        if method != "HEAD" {
            out.extend_from_slice(&body);
        }
        let mut stream = stream;
        stream.write_all(&out)?;
    }
}

/// Status line, media type and body.
fn respond(method: &str, target: &str, folder: &Path, prefix: &str) -> (&'static str, &'static str, Vec<u8>) {
    if method != "GET" && method != "HEAD" {
        return ("405 Method Not Allowed", "text/plain", b"only GET and HEAD".to_vec());
    }
    match file(target, folder, prefix).and_then(|path| Some((media_type(&path), std::fs::read(path).ok()?))) {
        Some((kind, body)) => ("200 OK", kind, body),
        None => ("404 Not Found", "text/plain", b"there is no such file".to_vec()),
    }
}

/// The file that a request means, if it lies in the folder.
fn file(target: &str, folder: &Path, prefix: &str) -> Option<PathBuf> {
    let path = target.split(['?', '#']).next()?.strip_prefix(prefix)?;
    let path = decode(path)?;
    let mut file = folder.to_owned();
    for part in path.split('/') {
        // Nothing above the folder, nothing hidden, nothing that another system reads as a path.
        if part.starts_with('.') || part.contains(['\\', ':', '\0']) {
            return None;
        }
        file.push(part);
    }
    if file.is_dir() {
        file.push("index.html");
    }
    let (inside, file) = (folder.canonicalize().ok()?, file.canonicalize().ok()?);
    (file.starts_with(inside) && file.is_file()).then_some(file)
}

/// Undoes `%20` and its like.
fn decode(path: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(path.len());
    let mut rest = path.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [rest.next()?, rest.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            other => other,
        });
    }
    String::from_utf8(bytes).ok()
}

fn media_type(path: &Path) -> &'static str {
    match path.extension().and_then(|extension| extension.to_str()).unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "wasm" => "application/wasm",
        "json" | "webmanifest" => "application/json",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "glb" => "model/gltf-binary",
        "gltf" => "model/gltf+json",
        "txt" | "md" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn serves_its_folder_and_nothing_else() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let status = |target: &str| respond("GET", target, folder, "/a/b/").0;
        assert_eq!(status("/a/b/Cargo.toml?x=1"), "200 OK");
        assert_eq!(status("/a/b/src/main%2Ers"), "200 OK");
        for outside in ["/Cargo.toml", "/a/b/../Cargo.toml", "/a/b/%2e%2e/Cargo.toml", "/a/b/src/..%2f..%2fCargo.toml"]
        {
            assert_eq!(status(outside), "404 Not Found", "{outside}");
        }
        for odd in ["", "/a/b", "/a/b//etc/passwd", "/a/b/%", "/a/b/%ff", "/a/b/src\\main.rs", "/a/b/missing"] {
            assert_eq!(status(odd), "404 Not Found", "{odd}");
        }
        assert_eq!(respond("POST", "/a/b/Cargo.toml", folder, "/a/b/").0, "405 Method Not Allowed");
    }

    #[test]
    fn wasm_is_sent_as_wasm() {
        assert_eq!(media_type(Path::new("pkg/page_bg.wasm")), "application/wasm");
        assert_eq!(media_type(Path::new("pkg/page.js")), "text/javascript; charset=utf-8");
    }
}
