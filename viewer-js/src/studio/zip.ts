// Files that belong together, in one archive: a zip without compression, as the server unpacks it.

const [LOCAL, CENTRAL, END] = [0x04034b50, 0x02014b50, 0x06054b50];
const [VERSION, UTF8, DAY] = [20, 0x0800, 0x21]; // the day is the first that a zip can have

interface Entry {
  name: Uint8Array;
  size: number;
  sum: number;
  at: number; // bytes before it
}

/** The files as one called `name`. */
export async function zipped(files: readonly File[], name: string): Promise<File> {
  const [parts, entries]: [BlobPart[], Entry[]] = [[], []];
  let at = 0;
  for (const file of files) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    const entry = { name: new TextEncoder().encode(file.name), size: bytes.length, sum: crc32(bytes), at };
    const head = header(LOCAL, [VERSION], entry, []);
    parts.push(head, bytes);
    entries.push(entry);
    at += head.size + bytes.length;
  }
  const list = entries.map((entry) => header(CENTRAL, [VERSION, VERSION], entry, [0, 0, 0, 0, 0, entry.at % 65536, entry.at >>> 16]));
  const length = list.reduce((sum, { size }) => sum + size, 0);
  const end = numbers([4, END], [2, 0, 0, files.length, files.length], [4, length, at], [2, 0]);
  return new File([...parts, ...list, end], name, { type: "application/zip" });
}

function header(sign: number, versions: number[], { name, size, sum }: Entry, rest: number[]): Blob {
  const known = numbers([4, sign], [2, ...versions, UTF8, 0, 0, DAY], [4, sum, size, size], [2, name.length, 0, ...rest]);
  return new Blob([known, name as BlobPart]);
}

/** Little-endian numbers: of each group the first says of how many bytes each of the others is. */
function numbers(...groups: readonly (readonly number[])[]): Blob {
  const bytes = groups.flatMap(([width, ...values]) =>
    values.flatMap((value) => Array.from({ length: width }, (_, i) => (value >>> (8 * i)) & 255)),
  );
  return new Blob([new Uint8Array(bytes)]);
}

function crc32(bytes: Uint8Array): number {
  let sum = -1;
  for (const byte of bytes) sum = TABLE[(sum ^ byte) & 255] ^ (sum >>> 8);
  return (sum ^ -1) >>> 0;
}

const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  let sum = n;
  for (let k = 0; k < 8; k++) sum = sum & 1 ? 0xedb88320 ^ (sum >>> 1) : sum >>> 1;
  return sum >>> 0;
});
