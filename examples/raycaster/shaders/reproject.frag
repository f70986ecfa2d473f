@version
// The nearest of the hit positions that are splatted onto a pixel; the depth test chooses it.

varying vec4 place;
@output FragColor

void main()
{
    FragColor = place;
}
